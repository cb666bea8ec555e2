# SPDX-License-Identifier: BSD-3-Clause
"""The folder of a study: rows of finished runs on disk, and the table of all of them.

FOLDER/parts has a Parquet file for each second or so of work. Once every run is made,
FOLDER/results.parquet has them all, sorted by index, in row groups of fixed size: the same bytes in
whatever order and by however many workers they were made. Every file is written beside its place
and then renamed, so that whatever ends the process leaves whole files only.
"""

from __future__ import annotations

import array
import contextlib
import fcntl
import os
import shutil
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from .._errors import SetupError, needed

if TYPE_CHECKING:
    from .plan import Study

#: Rows of a row group of the table, and most rows of a part.
GROUP = 16384
#: Of the files that this writes; their bytes depend on it.
_FORMAT = {"compression": "zstd", "version": "2.6", "write_statistics": True}


class NotWritten(Exception):
    """A file could not be written, as on a full disk; what was written before is sound."""

    def __init__(self, path: Path, error: OSError):
        super().__init__(f"{path}: not written: {error.strerror or error}")


@contextlib.contextmanager
def whole(path: Path) -> Iterator[IO[bytes]]:
    """A file to write that takes its place once it is whole, in a folder that is made for it.
    Raises NotWritten, and then leaves what was in its place."""
    beside = path.with_name(f".{path.name}.unfinished")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(beside, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, path)
    except OSError as error:
        raise NotWritten(path, error) from error
    finally:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)


def try_to_write(folder: Path) -> None:
    """Makes the folder. Raises NotWritten if a file of some size cannot be written there."""
    trial = folder / ".trial"
    with whole(trial) as file:
        file.write(bytes(1 << 16))
    trial.unlink()


def encoded(rows: Sequence[Mapping[str, Any]], columns: Sequence[tuple[str, str]]) -> bytes:
    """The rows as a record batch in Arrow's stream format."""
    pa = needed("pyarrow", extra="study")
    schema = schema_of(columns)
    batch = pa.record_batch([pa.array([row[each.name] for row in rows], each.type)
                             for each in schema], schema=schema)
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, schema) as stream:
        stream.write_batch(batch)
    text: bytes = sink.getvalue().to_pybytes()
    return text


def decoded(text: bytes) -> Any:
    """The table of what `encoded` returned."""
    return needed("pyarrow", extra="study").ipc.open_stream(text).read_all()


def schema_of(columns: Sequence[tuple[str, str]], metadata: Mapping[str, str] | None = None) -> Any:
    """Arrow's schema of columns (name, type)."""
    pa = needed("pyarrow", extra="study")
    kinds = {"int64": pa.int64(), "float64": pa.float64(), "string": pa.string(),
             "bool": pa.bool_()}
    return pa.schema([pa.field(name, kinds[kind]) for name, kind in columns], metadata)


def _unreadable(file: Path, error: Exception) -> SetupError:
    why = " ".join(str(error).split())  # Arrow's has lines
    return SetupError(f"{file}: cannot be read: {why}; allowed: to delete it, as --resume then "
                      "makes its runs again", str(file))


class Store:
    """The folder of one study, locked against a second process until `close`."""

    def __init__(self, folder: str | os.PathLike[str], study: Study, resume: bool = False):
        """resume: go on with what is there. Raises SetupError if there are runs without it, if they
        are another study's, or if another process writes to the folder."""
        self._pq = needed("pyarrow.parquet", "pyarrow", extra="study")
        self.folder = Path(folder)
        self.results = self.folder / "results.parquet"
        self._parts = self.folder / "parts"
        self._study = study
        self._schema = schema_of(study.columns, {"study": study.name, "identity": study.identity})
        self._kept: list[Any] = []  # tables that are in no part yet
        self._kept_rows = 0
        self._began = self._flushed = time.monotonic()
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            self._lock = os.open(self.folder, os.O_RDONLY)
        except OSError as error:
            raise NotWritten(self.folder, error) from error
        try:
            self._open(resume)
        except BaseException:
            self.close()
            raise

    def _open(self, resume: bool) -> None:
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise SetupError(f"{self.folder}: another process writes a study here; allowed: "
                             "another folder, or to wait for it", str(self.folder)) from None
        except OSError:
            pass  # a file system without locks
        there = self._files()
        if there and not resume:
            raise SetupError(f"{self.folder}: has runs already; allowed: --resume, which makes "
                             "those that are missing, or another folder", str(self.folder))
        self._done = np.zeros(self._study.runs, bool)
        for file in there:
            self._count(file)
        copy = self.folder / "study.yaml"
        text = self._study.text.encode()
        if not there and copy.exists() and copy.read_bytes() != text:
            raise SetupError(f"{copy}: is another study; allowed: another folder", str(copy))
        if self.results.exists():  # and has all that the parts had
            shutil.rmtree(self._parts, ignore_errors=True)
        if not self.finished:
            try:
                self._parts.mkdir(exist_ok=True)
                for unfinished in self._parts.glob(".*.unfinished"):
                    unfinished.unlink()
                if self.results.exists():  # of fewer runs, as what was said of them
                    os.replace(self.results, self._parts / "0.parquet")
                    for said in ("summary.json", "report.html"):
                        (self.folder / said).unlink(missing_ok=True)
            except OSError as error:
                raise NotWritten(self._parts, error) from error
        if not copy.exists():
            with whole(copy) as out:
                out.write(text)

    def _files(self) -> list[Path]:
        if self.results.exists():
            return [self.results]
        return sorted(self._parts.glob("[!.]*.parquet"))

    def _count(self, file: Path) -> None:
        """Marks the runs of a file as done."""
        try:
            opened = self._pq.ParquetFile(file)
            identity = (opened.schema_arrow.metadata or {}).get(b"identity", b"").decode()
            if identity != self._study.identity:
                raise SetupError(
                    f"{file}: has runs of another study, {identity[:12] or 'unknown'} and not "
                    f"{self._study.identity[:12]}: its file, its scene or a version has changed; "
                    "allowed: another folder, or the study and the versions of before", str(file))
            for group in range(opened.num_row_groups):
                done = opened.read_row_group(group, ["index"])["index"].to_numpy()
                if done.max() >= len(self._done):
                    raise SetupError(f"{file}: has run {done.max()}, this study {len(self._done)} "
                                     f"runs; allowed: --runs above {done.max()}", str(file))
                self._done[done] = True
        except (OSError, ValueError) as error:  # Arrow's are both
            if isinstance(error, SetupError):
                raise
            raise _unreadable(file, error) from error

    @property
    def missing(self) -> Sequence[int]:
        """The indices of the runs that are still to make."""
        return array.array("q", np.flatnonzero(~self._done).tobytes())

    @property
    def finished(self) -> bool:
        """Whether results.parquet is there, with every run."""
        return self.results.exists() and bool(self._done.all())

    def add(self, table: Any) -> None:
        """Takes rows; they are on disk a second later, of a long study after a hundredth of its
        time and half a minute at most. Raises NotWritten."""
        index = table["index"].to_numpy()
        fresh = ~self._done[index]
        if not fresh.all():  # made twice, as it was taken for lost
            table = table.filter(fresh)
        self._done[index] = True
        self._kept.append(table)
        self._kept_rows += len(table)
        now = time.monotonic()
        if (self._kept_rows >= GROUP
                or now - self._flushed > min(max(1.0, 0.01 * (now - self._began)), 30.0)):
            self.flush()

    def flush(self) -> None:
        """Writes what was taken. Raises NotWritten."""
        if self._kept_rows == 0:
            return
        pa = needed("pyarrow", extra="study")
        table = pa.concat_tables(self._kept).sort_by("index").replace_schema_metadata(
            self._schema.metadata)
        with whole(self._parts / f"{table['index'][0]}.parquet") as file:
            self._pq.write_table(table, file, row_group_size=GROUP, **_FORMAT)
        self._kept, self._kept_rows = [], 0
        self._flushed = time.monotonic()

    def finish(self) -> Path:
        """Writes the table of all runs, removes the parts and returns the path of the table. Holds
        a row group in memory. Raises NotWritten."""
        self.flush()
        assert self._done.all()
        if not self.finished:
            with whole(self.results) as file:
                with self._pq.ParquetWriter(file, self._schema, **_FORMAT) as writer:
                    for table in self._sorted():
                        writer.write_table(table, row_group_size=GROUP)
            shutil.rmtree(self._parts, ignore_errors=True)
        return self.results

    def _sorted(self) -> Iterator[Any]:
        """The rows in tables of GROUP, of the last one the rest, in the order of their index."""
        pa = needed("pyarrow", extra="study")
        spans = []  # of each row group: file, number, least and largest index
        for path in self._files():
            about = self._pq.read_metadata(path)
            for number in range(about.num_row_groups):
                index = about.row_group(number).column(0).statistics
                spans.append((path, number, index.min, index.max))
        for first in range(0, self._study.runs, GROUP):
            end = min(first + GROUP, self._study.runs)
            pieces = []
            for path, number, least, largest in spans:
                if least < end and largest >= first:
                    try:
                        piece = self._pq.ParquetFile(path).read_row_group(number)
                    except (OSError, ValueError) as error:
                        raise _unreadable(path, error) from error
                    index = piece["index"].to_numpy()
                    pieces.append(piece.filter((index >= first) & (index < end)))
            table = pa.concat_tables(pieces).sort_by("index").combine_chunks()
            assert np.array_equal(table["index"].to_numpy(), np.arange(first, end))
            yield table.replace_schema_metadata(self._schema.metadata)

    def discard(self) -> None:
        """Takes away what stands for a study of which no run was made."""
        if not self._files():
            shutil.rmtree(self._parts, ignore_errors=True)
            (self.folder / "study.yaml").unlink(missing_ok=True)

    def close(self) -> None:
        """Lets the folder go. Rows that are in no part yet are dropped."""
        if self._lock >= 0:
            os.close(self._lock)
            self._lock = -1

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
