#!/usr/bin/env bash
# Every file and symbol that docs/theory.md names exists, and a symbol that stands in front of a file is one of that file;
# files and symbols of the library that the other documents name exist, too.
set -euo pipefail
python3 tests/api/theory.py
