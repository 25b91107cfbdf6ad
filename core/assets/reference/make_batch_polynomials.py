#!/usr/bin/env python3
"""Prints the polynomials of src/model/batch/elementary.rs and trigonometry.rs: interpolation at Chebyshev nodes in 50-digit arithmetic, rounded to doubles.

Needs mpmath. Beside each polynomial: the largest relative error of the function with the rounded coefficients, without rounding in its evaluation.
"""

from mpmath import cos, exp, linspace, log, lu_solve, matrix, mp, mpf, nstr, pi, polyval, sin, sqrt

mp.dps = 50


def interpolate(function, low, high, degree):
    """Coefficients, lowest first, as doubles."""
    count = degree + 1
    nodes = [(low + high) / 2 + (high - low) / 2 * cos(pi * (2 * i + 1) / (2 * count)) for i in range(count)]
    powers = matrix(count, count)
    values = matrix(count, 1)
    for i, node in enumerate(nodes):
        values[i] = function(node)
        for j in range(count):
            powers[i, j] = node**j
    solution = lu_solve(powers, values)
    return [float(solution[j]) for j in range(count)]


def value(coefficients, x):
    return polyval([mpf(c) for c in reversed(coefficients)], x)


# Reduced arguments, a little widened for the rounding of the reduction.
HALF_LN_2 = log(2) / 2 * mpf("1.0001")
LARGEST_S_SQ = ((sqrt(2) - 1) / (sqrt(2) + 1)) ** 2 * mpf("1.0001")


def q(r):
    return (exp(r) - 1 - r) / r**2 if abs(r) > mpf(10) ** -12 else mpf(1) / 2 + r / 6


def big_r(z):
    if z < mpf(10) ** -14:
        return mpf(2) / 3 + z * 2 / 5
    s = sqrt(z)
    return (log((1 + s) / (1 - s)) - 2 * s) / s / z


exponential = interpolate(q, -HALF_LN_2, HALF_LN_2, 9)
error = max(abs((1 + r + r * r * value(exponential, r)) / exp(r) - 1) for r in linspace(-HALF_LN_2, HALF_LN_2, 2001))
print("Q", nstr(error, 3), *map(repr, exponential), sep="\n  ")

logarithm = interpolate(big_r, mpf(0), LARGEST_S_SQ, 6)
error = max(abs((2 + z * value(logarithm, z)) / (2 + z * big_r(z)) - 1) for z in linspace(0, LARGEST_S_SQ, 2001))
print("R", nstr(error, 3), *map(repr, logarithm), sep="\n  ")

LARGEST_ANGLE_SQ = (pi / 4) ** 2 * mpf("1.0001")


def big_s(z):
    if z < mpf(10) ** -12:
        return -mpf(1) / 6 + z / 120
    x = sqrt(z)
    return (sin(x) / x - 1) / z


for name, largest, degree in (("S", LARGEST_ANGLE_SQ, 5), ("L", LARGEST_ANGLE_SQ * 4, 7)):
    sine = interpolate(big_s, mpf(0), largest, degree)
    error = max(abs((1 + z * value(sine, z)) / (1 + z * big_s(z)) - 1) for z in linspace(0, largest, 2001))
    print(name, nstr(error, 3), *map(repr, sine), sep="\n  ")
