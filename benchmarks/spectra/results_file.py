"""What the programs of flatland share: their results' files, and pictures."""

import json
import sys


def write(program, path, results):
    """Writes results to a JSON file; ends the program with one line if it can't."""
    try:
        with open(path, "w", encoding="utf-8") as file:
            json.dump(results, file, indent=1)
            file.write("\n")
    except OSError as error:
        sys.exit(f"{program}: error: {path}: {error}: name a file that can be written")


def pyplot(program):
    """matplotlib without a screen; ends the program with one line where it is not installed."""
    try:
        import matplotlib
    except ImportError:
        sys.exit(f"{program}: error: matplotlib: not installed: apt install python3-matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    return plt
