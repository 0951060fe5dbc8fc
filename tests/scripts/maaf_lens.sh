#!/usr/bin/env bash
# maaf_lens.sh SOURCE: filters of a lens and a light against the definitions. Exit status 77 without Debian's python3-numpy.
set -euo pipefail
/usr/bin/python3 -c "import numpy" 2>/dev/null || exit 77
PYTHONDONTWRITEBYTECODE=1 exec /usr/bin/python3 "$1/tests/scripts/maaf_lens.py" "$1/benchmarks/spectra"
