#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a C++ source that holds the files of web/dist, packed by gzip.

usage: tools/embed_web.py web/dist OUT.cpp
"""

import gzip
import hashlib
import pathlib
import sys

MEDIA_TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8",
               ".css": "text/css; charset=utf-8", ".svg": "image/svg+xml", ".txt": "text/plain"}


def literal(data):
    """The bytes as lines of a C++ array."""
    lines = [data[i:i + 64] for i in range(0, len(data), 64)]
    return "\n".join("  " + ",".join(f"{byte}" for byte in line) + "," for line in lines)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    files = sorted(path for path in root.rglob("*") if path.is_file())
    if not any(path.name == "index.html" for path in files):
        sys.exit(f"{root}: holds no index.html")
    arrays, entries = [], []
    for number, path in enumerate(files):
        packed = gzip.compress(path.read_bytes(), 9, mtime=0)
        name = path.relative_to(root).as_posix()
        media_type = MEDIA_TYPES.get(path.suffix)
        if media_type is None:
            sys.exit(f"{path}: no media type is known for it")
        etag = hashlib.sha256(packed).hexdigest()[:16]
        arrays.append(f"constexpr unsigned char kFile{number}[] = {{\n{literal(packed)}\n}};")
        entries.append(f'    {{"/{name}", "{media_type}",\n     {{reinterpret_cast<const char*>'
                       f'(kFile{number}), sizeof(kFile{number})}}, "\\"{etag}\\""}},')
    text = "\n".join([
        "// SPDX-License-Identifier: Apache-2.0", "// Made by tools/embed_web.py from web/dist.",
        '#include "nadir/viewer/web_assets.hpp"', "", "namespace nadir {", "namespace {", "",
        "\n\n".join(arrays), "", "}  // namespace", "", "std::span<const WebAsset> web_assets() {",
        "  static const WebAsset assets[] = {", *entries, "  };", "  return assets;", "}", "",
        "}  // namespace nadir", ""])
    pathlib.Path(sys.argv[2]).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
