"""The model with the causes: refitted values, their uncertainty, errors on the test record."""

from modelgen.diagnosis.extended.elastic_doubt import with_elastic_doubt
from modelgen.diagnosis.extended.extended_model import (
    Extension,
    FittedModel,
    extend,
    replay,
    unit_of_efforts,
    without,
)
from modelgen.diagnosis.extended.findings import Errors, Estimate, NamedCause, Positions, Share
from modelgen.diagnosis.extended.test_errors import (
    errors,
    motion_errors,
    motion_shares,
    on_test,
    residuals,
    shares,
)
from modelgen.diagnosis.extended.uncertainty import base_estimates, cause_estimates, covariance_of_base

__all__ = [
    "Errors",
    "Estimate",
    "Extension",
    "FittedModel",
    "NamedCause",
    "Positions",
    "Share",
    "base_estimates",
    "cause_estimates",
    "covariance_of_base",
    "errors",
    "extend",
    "motion_errors",
    "motion_shares",
    "on_test",
    "replay",
    "residuals",
    "shares",
    "unit_of_efforts",
    "with_elastic_doubt",
    "without",
]
