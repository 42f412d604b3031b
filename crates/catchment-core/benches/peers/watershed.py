"""Basins of a raw float32 array by scikit-image: basins, then the fastest of three runs in seconds, per neighbourhood.

usage: watershed.py FILE CELLS_PER_AXIS AXES
"""

import sys
import time

import numpy
import skimage
from skimage.segmentation import watershed

path, cells, axes = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
field = numpy.fromfile(path, dtype=numpy.float32).reshape((cells,) * axes)
print(skimage.__version__)
for connectivity in (1, axes):
    times = []
    for _ in range(3 if connectivity == 1 else 1):
        start = time.perf_counter()
        labels = watershed(field, connectivity=connectivity)
        times.append(time.perf_counter() - start)
    print(connectivity, labels.max(), min(times))
