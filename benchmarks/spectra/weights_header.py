#!/usr/bin/python3
"""Writes the table of fit_maaf.py as the header that the renderer's filter includes.

usage: weights_header.py TABLE.json > kernels/filter/refitted_weights.h

Rows are over s_max / s_min, as far as the renderer lets it go.
"""

import json
import sys

MOST_RATIO = 4.0


def header(tables):
    """The text, of {components: rows of ratio and weights}."""
    lines = ["// Generated from benchmarks/spectra/maaf_weights.json by benchmarks/spectra/weights_header.py: weights of components,",
             "// of each pair of its cosines and of its sines, at s_max / s_min = 2^(k / 4), k = 0, 1, ...",
             "// clang-format off", "#ifndef WEDGE_REFITTED_WEIGHTS_H", "#define WEDGE_REFITTED_WEIGHTS_H", ""]
    rows = {int(count): [row["weights"] for row in table if row["ratio"] <= MOST_RATIO * 1.0001] for count, table in tables.items()}
    lines += [f"#define WEDGE_REFITTED_ROWS {len(next(iter(rows.values())))}", ""]
    for k, (count, table) in enumerate(sorted(rows.items())):
        lines.append(f"#{'el' if k else ''}if WEDGE_COMPONENTS == {count}")
        lines.append(f"__constant float refittedWeights[WEDGE_REFITTED_ROWS][{count}] = {{")
        lines += [f"    {{ {', '.join(f'{w:.6e}f' for w in weights)} }}," for weights in table]
        lines.append("};")
    return "\n".join(lines + ["#endif", "", "#endif"]) + "\n"


def main(arguments):
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    try:
        with open(arguments[0], encoding="utf-8") as file:
            tables = json.load(file)["tables"]
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"weights_header: error: {arguments[0]}: {error}: name what fit_maaf.py wrote")
    sys.stdout.write(header(tables))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
