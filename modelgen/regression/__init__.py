"""Least squares with weights by joint, and the noise's autocovariance."""
