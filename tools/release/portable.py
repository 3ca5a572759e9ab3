"""Make an extension load on systems with an older glibc.

Usage: python portable.py WHEEL FOLDER

The extension must be linked with SNOWSHED_OLD_GLIBC. Functions of glibc in a version after 2.28 are
taken in their first version, which every later glibc has, too: they differ in rare errors only. The
wheel is written to FOLDER.
"""

from __future__ import annotations

import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

from elftools.elf.elffile import ELFFile

LIMIT = (2, 28)
BASE = "GLIBC_2.2.5"  # the first version on x86-64, which every function of these has
VERSION = re.compile(r"GLIBC_(\d+)\.(\d+)")
#: Libraries that held functions of libc before glibc 2.34.
FORMER_LIBRARIES = ("libpthread.so.0", "libdl.so.2")


def make_portable(library: Path) -> None:
    """Replace versions of glibc that are too new by the first one, in the table of versions.

    An entry of the table (ELF's Vernaux) has the hash of its version's name, flags, an index, and
    the place of the name: 4, 2, 2 and 4 bytes.
    """
    needed = [part for name in FORMER_LIBRARIES for part in ("--add-needed", name)]
    subprocess.run(["patchelf", *needed, library], check=True)
    with library.open("r+b") as stream:
        elf = ELFFile(stream)
        section = elf.get_section_by_name(".gnu.version_r")
        entries = [entry for _, group in section.iter_versions() for entry in group]
        base = next(entry for entry in entries if entry.name == BASE)
        content = bytearray(section.data())
        for entry in entries:
            parts = VERSION.fullmatch(entry.name)
            if parts and (int(parts[1]), int(parts[2])) > LIMIT:
                old = struct.pack("<I", entry["vna_hash"])
                at = next(
                    place
                    for place in range(0, len(content), 4)
                    if content[place : place + 4] == old
                    and content[place + 6 : place + 8] == struct.pack("<H", entry["vna_other"])
                )
                content[at : at + 4] = struct.pack("<I", base["vna_hash"])
                content[at + 8 : at + 12] = struct.pack("<I", base["vna_name"])
        stream.seek(section["sh_offset"])
        stream.write(content)


def main(wheel: Path, folder: Path) -> None:
    """Write the portable wheel."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as temporary:
        tool = [sys.executable, "-m", "wheel"]
        subprocess.run([*tool, "unpack", "-d", temporary, wheel], check=True)
        (unpacked,) = Path(temporary).iterdir()
        for library in unpacked.rglob("_core*.so"):
            make_portable(library)
        subprocess.run([*tool, "pack", "-d", folder, unpacked], check=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
