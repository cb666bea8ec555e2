#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds MCAP files to the package `mcap` from PyPI, which shares nothing with the library.

Reads each file by its summary and from front to back, with every CRC checked, compares the two with
the statistics, topic by topic, and prints a table. Then it cuts the file in many places: from front
to back, every chunk before the cut must still be there. Exit code: 0 when all is well, 1 when
something is not, 77 when the package is missing.
"""
import argparse
import collections
import io
import struct
import sys
import zlib

try:
    import zstandard  # which mcap needs as well
    from mcap.exceptions import McapError
    from mcap.reader import NonSeekingReader, SeekingReader
    from mcap.records import Attachment, Footer, Message, Metadata
    from mcap.stream_reader import StreamReader
except ImportError:
    print("skipped: pip install mcap")
    sys.exit(77)

MAGIC = b"\x89MCAP0\r\n"
# What the package throws when a file ends too early, beside its own McapError.
CUT_OFF = (McapError, ValueError, struct.error)


class Wrong(Exception):
    """Something that a file gets wrong."""


def require(held, what):
    if not held:
        raise Wrong(what)


def by_summary(data):
    """The summary, messages per topic, attachments and metadata, all found by the indices."""
    reader = SeekingReader(io.BytesIO(data), validate_crcs=True)
    summary = reader.get_summary()
    require(summary is not None and summary.statistics is not None, "there is no summary")
    counts = collections.Counter()
    last_ns = 0
    for _, channel, message in reader.iter_messages():
        require(message.log_time >= last_ns, "messages by index are out of order")
        last_ns = message.log_time
        counts[channel.topic] += 1
    return summary, counts, list(reader.iter_attachments()), list(reader.iter_metadata())


def by_stream(data):
    """Messages per topic, attachments and metadata, read from front to back."""
    counts = collections.Counter()
    for _, channel, _ in NonSeekingReader(io.BytesIO(data), validate_crcs=True).iter_messages(
            log_time_order=False):
        counts[channel.topic] += 1
    records = list(StreamReader(io.BytesIO(data), validate_crcs=True).records)
    return (counts, [r for r in records if isinstance(r, Attachment)],
            [r for r in records if isinstance(r, Metadata)],
            next(r for r in records if isinstance(r, Footer)))


def check_statistics(summary, counts, attachments, metadata):
    s = summary.statistics
    expected = {
        "message_count": sum(counts.values()),
        "schema_count": len(summary.schemas),
        "channel_count": len(summary.channels),
        "attachment_count": len(attachments),
        "metadata_count": len(metadata),
        "chunk_count": len(summary.chunk_indexes),
    }
    for name, value in expected.items():
        require(getattr(s, name) == value, f"{name} is {getattr(s, name)}, but there are {value}")
    for key, channel in summary.channels.items():
        said = s.channel_message_counts.get(key, 0)
        require(said == counts[channel.topic],
                f"{channel.topic}: {said} messages in the statistics, {counts[channel.topic]} read")


def check_message_indices(data, summary):
    """Every place that a message index gives holds a message of that channel and time."""
    for chunk in summary.chunk_indexes:
        places = set()
        records = records_of(data, chunk)
        for channel, offset in chunk.message_index_offsets.items():
            require(data[offset] == 0x07, f"no message index at byte {offset}")
            found, size = struct.unpack_from("<HI", data, offset + 9)
            require(found == channel, f"the index at byte {offset} is that of another channel")
            for time_ns, at in struct.iter_unpack("<QQ", data[offset + 15:offset + 15 + size]):
                op, _, of, _, log_time = struct.unpack_from("<BQHIQ", records, at)
                require((op, of, log_time) == (0x05, channel, time_ns), f"no message at byte {at}")
                places.add(at)
        require(len(places) == messages_in(records),
                f"messages of the chunk at byte {chunk.chunk_start_offset} have no index")


def records_of(data, chunk):
    """The records of a chunk, decompressed."""
    end = chunk.chunk_start_offset + chunk.chunk_length
    stored = data[end - chunk.compressed_size:end]
    if chunk.compression == "":
        return stored
    require(chunk.compression == "zstd", f"the compression is {chunk.compression!r}")
    return zstandard.ZstdDecompressor().decompress(stored, chunk.uncompressed_size)


def messages_in(records):
    """How many of them are messages."""
    count, at = 0, 0
    while at < len(records):
        op, length = struct.unpack_from("<BQ", records, at)
        count += op == 0x05
        at += 9 + length
    return count


def check_summary_crc(data, footer):
    found = zlib.crc32(data[footer.summary_start:len(data) - 12])
    require(found == footer.summary_crc, f"summary CRC {footer.summary_crc:#x}, not {found:#x}")


def readable(data):
    """How many messages come before a file that is cut off has no more."""
    count = 0
    try:
        for record in StreamReader(io.BytesIO(data), validate_crcs=True).records:
            count += isinstance(record, Message)
    except CUT_OFF:
        pass
    return count


def check_cuts(data, summary, cuts):
    in_chunks = [(chunk.chunk_start_offset + chunk.chunk_length,
                  messages_in(records_of(data, chunk)))
                 for chunk in summary.chunk_indexes]
    for k in range(cuts):
        length = len(data) * k // cuts
        least = sum(count for end, count in in_chunks if end <= length)
        found = readable(data[:length])
        require(found >= least,
                f"cut at byte {length}: {found} messages, {least} in the chunks before")


def check(path, cuts):
    with open(path, "rb") as file:
        data = file.read()
    require(data[-8:] == MAGIC, "it is cut off (see --cut-off)")
    summary, counts, attachments, metadata = by_summary(data)
    streamed, streamed_attachments, streamed_metadata, footer = by_stream(data)
    require(counts == streamed, f"by index {dict(counts)}, from front to back {dict(streamed)}")
    require(attachments == streamed_attachments, "attachments by index are others")
    require(metadata == streamed_metadata, "metadata by index are others")
    check_statistics(summary, counts, attachments, metadata)
    check_message_indices(data, summary)
    check_summary_crc(data, footer)
    check_cuts(data, summary, cuts)

    span = summary.statistics.message_end_time - summary.statistics.message_start_time
    print(f"{path}: {len(data)} bytes, {len(summary.chunk_indexes)} chunks, {span / 1e9:.3f} s, "
          f"{len(attachments)} attachments, {len(metadata)} metadata, {cuts} cuts")
    for key, channel in sorted(summary.channels.items()):
        schema = summary.schemas.get(channel.schema_id)
        print(f"  {channel.topic:<32} {counts[channel.topic]:>9} messages  "
              f"{channel.message_encoding:<10} {schema.name if schema else '-'}")


def check_cut_file(path):
    with open(path, "rb") as file:
        data = file.read()
    count = readable(data)
    print(f"{path}: {len(data)} bytes, cut off; {count} messages")
    require(count > 0, "no message can be read")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--cuts", type=int, default=50, help="places to cut each file at")
    parser.add_argument("--cut-off", action="store_true",
                        help="the files are cut off: messages must be found, no more")
    arguments = parser.parse_args()
    failed = False
    for path in arguments.files:
        try:
            if arguments.cut_off:
                check_cut_file(path)
            else:
                check(path, arguments.cuts)
        except (Wrong, OSError, *CUT_OFF) as error:
            failed = True
            print(f"{path}: {error or type(error).__name__}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
