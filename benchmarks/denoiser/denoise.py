#!/usr/bin/env python3
"""Denoises one image by Open Image Denoise (PyPI's pyoidn), for the benchmark `denoiser`.

denoise.py                                           status 0 if pyoidn is there, else 3
denoise.py WIDTH HEIGHT COLOR ALBEDO NORMAL OUTPUT   files of 32-bit floats, three a pixel; prints milliseconds
"""
import statistics
import sys
import time

try:
    import numpy
    import pyoidn
except ImportError as missing:
    print(missing, file=sys.stderr)
    sys.exit(3)

RUNS = 3  # after one that loads the network


def main(arguments):
    if not arguments:
        return 0
    width, height = int(arguments[0]), int(arguments[1])
    color, albedo, normal = (
        numpy.fromfile(path, dtype=numpy.float32).reshape(height, width, 3) for path in arguments[2:5]
    )
    times = []
    for _ in range(RUNS + 1):
        start = time.perf_counter()
        output = pyoidn.denoise(color, albedo=albedo, normal=normal, hdr=True)
        times.append(1e3 * (time.perf_counter() - start))
    numpy.asarray(output, dtype=numpy.float32).tofile(arguments[5])
    print(statistics.median(times[1:]))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
