"""Measured logs: reading, checking, processing."""

from modelgen.dataset.drives import NumericDrive, drives_of
from modelgen.dataset.objects import Record
from modelgen.dataset.processing.prepare import Prepared, prepare
from modelgen.dataset.processing.settings import PRESETS, Chosen, Settings, choose, preset
from modelgen.dataset.processing.spectra import described, spectra, spectra_svg
from modelgen.dataset.processing.splitting import split, split_said
from modelgen.dataset.reading.column_table import ColumnTable, Log, named
from modelgen.dataset.reading.gathering import check_different, gather, several
from modelgen.dataset.reading.read import read
from modelgen.dataset.reading.sources import dated_columns, read_columns
from modelgen.dataset.reading.specs import Spec, check_separate, last_quarter_out, parse
from modelgen.dataset.streaming import Stream
from modelgen.dataset.thresholds import DatasetThresholds

__all__ = [
    "PRESETS",
    "Chosen",
    "ColumnTable",
    "DatasetThresholds",
    "Log",
    "NumericDrive",
    "Prepared",
    "Record",
    "Settings",
    "Spec",
    "Stream",
    "check_different",
    "check_separate",
    "choose",
    "dated_columns",
    "described",
    "drives_of",
    "gather",
    "last_quarter_out",
    "named",
    "parse",
    "prepare",
    "preset",
    "read",
    "read_columns",
    "several",
    "spectra",
    "spectra_svg",
    "split",
    "split_said",
]
