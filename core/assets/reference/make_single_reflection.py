"""Values of 1 − ρ(θi; σ) to 15 digits: what single reflection by a perfect reflector in V-grooves loses (Gauss).

The integrand min(u, 2, 4u/(1 + s²) − 2), 0 where negative, of src/optics/grooves.rs is integrated by mpmath over azimuth and slope as it
stands, split where it has kinks; none of the closed forms of the program are used. Made with Python 3.11, mpmath 1.3.

    python3 make_single_reflection.py
"""
from mpmath import mp, mpf, quad, sqrt, exp, acos, pi, cos, tan, radians, inf

mp.dps = 25


def kept(s, t):
    """Mean of G u over the azimuths of facets of slope s."""
    if s * t == 0:
        return max(min(mpf(1), 2, 4 / (1 + s * s) - 2), 0)
    edges = [mpf(2), (1 + s * s) / 2, 1 + s * s]
    if s * s < 3:
        edges.append(2 * (1 + s * s) / (3 - s * s))
    cuts = sorted([mpf(0), pi] + [acos((1 - u) / (s * t)) for u in edges if abs(1 - u) < s * t])
    f = lambda phi: max(min(1 - s * t * cos(phi), 2, 4 * (1 - s * t * cos(phi)) / (1 + s * s) - 2), 0)
    return quad(f, cuts, maxdegree=5) / pi


def lost(theta, sigma):
    th = mpf(theta)
    t = tan(radians(th))
    tilts = sorted({30 - th / 3, 45 - th / 2, th, 90 - th, 30 + th / 3, 45 + th / 2, mpf(45)})
    tilts = [a for a in tilts if 30 - th / 3 <= a <= 45 + th / 2]
    cuts = [tan(radians(a)) for a in tilts]
    while any(b > 4 * a for a, b in zip(cuts, cuts[1:])):
        i = next(i for i in range(len(cuts) - 1) if cuts[i + 1] > 4 * cuts[i])
        cuts.insert(i + 1, sqrt(cuts[i] * cuts[i + 1]))
    weight = lambda s: s / sigma**2 * exp(-s * s / (2 * sigma**2))
    body = quad(lambda s: (1 - kept(s, t)) * weight(s), cuts, maxdegree=5)
    return body + exp(-cuts[-1] ** 2 / (2 * sigma**2))


for theta, sigma in [(0, "0.1"), (45, "0.3"), (60, "0.05"), (75, "0.7"), (85, "0.3"), (89, "0.1")]:
    print(theta, sigma, mp.nstr(lost(theta, mpf(sigma)), 15), flush=True)
