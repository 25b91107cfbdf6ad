#!/usr/bin/env python3
"""Prints the polynomials of src/model/batch/elementary.rs and trigonometry.rs: interpolation at Chebyshev nodes in 50-digit arithmetic, rounded to doubles.

Needs mpmath. Beside each polynomial: the largest relative error of the function with the rounded coefficients, without rounding in its evaluation.
"""

from mpmath import cos, linspace, log, lu_solve, matrix, mp, mpf, nstr, pi, polyval, sin, sqrt

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


def show(name, error, coefficients):
    print(name, nstr(error, 3), *map(repr, coefficients), sep="\n  ")


# Reduced arguments, a little widened for the rounding of the reduction.
HALF = mpf("0.50005")
LARGEST_S_SQ = ((sqrt(2) - 1) / (sqrt(2) + 1)) ** 2 * mpf("1.0001")


def q(f):
    return (mpf(2) ** f - 1) / f if abs(f) > mpf(10) ** -12 else log(2) + f * log(2) ** 2 / 2


def big_r(z):
    if z < mpf(10) ** -14:
        return mpf(2) / 3 + z * 2 / 5
    s = sqrt(z)
    return (log((1 + s) / (1 - s)) - 2 * s) / s / z


power = interpolate(q, -HALF, HALF, 10)
error = max(abs((1 + f * value(power, f)) / mpf(2) ** f - 1) for f in linspace(-HALF, HALF, 2001))
show("Q_EVEN, then Q_ODD", error, power[::2] + power[1::2])

logarithm = interpolate(big_r, mpf(0), LARGEST_S_SQ, 6)
error = max(abs((2 + z * value(logarithm, z)) / (2 + z * big_r(z)) - 1) for z in linspace(0, LARGEST_S_SQ, 2001))
show("R", error, logarithm)

# π/360 as a double, so that the sine of half a small angle has all digits.
HALF_DEGREE = float(pi / 360)


def sine_of_half_over_angle(z):
    """sin ½θ/θ, θ in degrees, z = θ²."""
    if z == 0:
        return pi / 360
    degrees = sqrt(z)
    return sin(degrees * pi / 360) / degrees


for name, largest, degree in (("S", 90, 5), ("L", 180, 7)):
    largest_sq = mpf(largest) ** 2 * mpf("1.0001")
    sine = [HALF_DEGREE, *interpolate(lambda z: (sine_of_half_over_angle(z) - mpf(HALF_DEGREE)) / z, mpf(0), largest_sq, degree)]
    error = max(abs(value(sine, z) / sine_of_half_over_angle(z) - 1) for z in linspace(0, largest_sq, 2001))
    show(name, error, sine)
