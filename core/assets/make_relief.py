#!/usr/bin/env python3
"""Writes relief.csv: the rough height field of the picture, z(x, y) = sum of height sin(kx x + ky y + phase) for x, y in -1...1.

    python3 core/assets/make_relief.py > core/assets/relief.csv

Wave numbers are spread evenly over directions and evenly in their logarithm, heights fall off so that every wave adds the same slope, and the
rms slope of all is 0.35. Phases come from a golden-ratio sequence, so that no random numbers are needed.
"""
import math

WAVES, SLOWEST, FASTEST, RMS_SLOPE = 24, 2.5, 16.0, 0.35
GOLDEN = (math.sqrt(5) - 1) / 2

slope = RMS_SLOPE / math.sqrt(WAVES / 2)
print("# A rough height field: z(x, y) = sum of height sin(kx x + ky y + phase), x and y in -1 ... 1, phase in radians.")
print("# Written by make_relief.py.")
print("kx,ky,height,phase")
for wave in range(WAVES):
    number = SLOWEST * (FASTEST / SLOWEST) ** (wave / (WAVES - 1))
    direction = math.pi * (wave * GOLDEN % 1)
    phase = 2 * math.pi * (wave * wave * GOLDEN % 1)
    print(f"{number * math.cos(direction):.4f},{number * math.sin(direction):.4f},{slope / number:.6f},{phase:.4f}")
