"""Least squares with weights by joint, the noise's autocovariance, instruments, parts held out in turn."""
