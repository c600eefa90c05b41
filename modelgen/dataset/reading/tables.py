"""Named columns of numbers, whatever file they come from: the header, then blocks of rows."""

from __future__ import annotations

from pathlib import Path

from modelgen.dataset.objects import Layout, Reader
from modelgen.dataset.reading.array_table import ARRAYS, array_table
from modelgen.dataset.reading.bag_messages import bag_files
from modelgen.dataset.reading.bags import BagReader
from modelgen.dataset.reading.csv_table import CsvReader
from modelgen.dataset.reading.parquet_table import ParquetReader
from modelgen.dataset.reading.specs import unreadable
from modelgen.errors import InputError

BAGS = (".bag", ".db3", ".mcap")
TEXTS = (".csv", ".txt", ".tsv", ".dat", ".log", ".asc", "")
SHEETS = (".xlsx", ".xls", ".xlsm", ".ods")


def open_table(path: Path, layout: Layout | None = None) -> Reader:
    """The reader for a file, by its suffix; a folder is a ROS 2 bag. Raises InputError.

    layout: of a table in a text file, as far as it is known. A pipe is read as such a table.
    """
    suffix = path.suffix.lower()
    try:
        path.stat()
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from None
    if path.is_dir():
        if bag_files(path) == [path] and not (path / "metadata.yaml").exists():
            raise unreadable(path, IsADirectoryError())
        return BagReader(path)
    if suffix in BAGS:
        return BagReader(path)
    if suffix in (".parquet", ".pq"):
        return ParquetReader(path)
    if suffix in ARRAYS:
        return array_table(path, layout.columns if layout else ())
    if suffix == ".gz":  # of a table of text
        suffix = Path(path.stem).suffix.lower()
        suffix = suffix if suffix in TEXTS else ".gz"
    if suffix in TEXTS or path.is_fifo():
        return CsvReader(path, layout)
    kinds = ".csv, .csv.gz, .txt, .tsv, .parquet, .mat, .npz, .bag, .db3, .mcap, or the folder of a ROS 2 bag"
    hint = "; in the spreadsheet, save the sheet as CSV UTF-8" if suffix in SHEETS else ""
    if suffix == ".active":
        hint = "; a bag that was not closed: `rosbag reindex FILE`, then name it .bag"
    raise InputError(f"{path}: found a log of the kind '{suffix}', expected {kinds}{hint}")
