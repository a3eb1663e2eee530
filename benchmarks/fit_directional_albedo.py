#!/usr/bin/env python3
"""Fits the directional albedos of shaders/bsdf/albedo.glsl; prints its constants and errors.

Needs NumPy and SciPy: on Debian the package python3-scipy, whose modules only /usr/bin/python3 finds.

Truth: quadrature over half vectors with the light above the horizon, whose edge is exact. Fits: rational functions
whose errors are held one-sided by linear programs, as N / Q in [low, high] is low Q <= N <= high Q. Checks: single
precision, on grids that the fits have not seen. Exits 1 where a bound is broken. Takes about two minutes.
"""
import math
import sys

try:
    import numpy as np
    from scipy.optimize import linprog
except ImportError as missing:
    sys.exit(f"{missing}: install the Debian package python3-scipy, and run this with /usr/bin/python3")

UNDER, OVER = 2e-4, 6e-3  # bounds of fit - truth
# Bounds of the sheen's fit - truth: it falls short by SHEEN_UNDER at most, and exceeds the truth by the lesser of
# SHEEN_OVER max(1, truth) and SHEEN_RELATIVE truth + SHEEN_DARK.
SHEEN_UNDER, SHEEN_OVER, SHEEN_RELATIVE, SHEEN_DARK = 2e-4, 1e-2, 2e-2, 2e-5
MIN_ALPHA, MIN_SHEEN_ALPHA = 1e-4, 0.07**2
MEAN_LOW, MEAN_HIGH = 0.99, 1 + 3e-4  # bounds of (1 - mean of the fit) / (1 - fitted mean)

# ---- Truth


def half_vector_quadrature(mu, warp, unwarp, integrand, nodes=(48, 32)):
    """∫ D integrand dω over half vectors h whose light l is above the horizon, for each cosine of view mu.

    With θ the angle of h, l is above it for every azimuth if 2θ < 90° - θv, for none if 2θ > 90° + θv, and for
    |φ| < acos(-cot θv cot 2θ) between. warp maps θ to where D is smooth; unwarp gives θ and D sin θ dθ of it back.
    Cosine substitutions take the square roots at the ends.
    """

    def ends(n):
        x, w = np.polynomial.legendre.leggauss(n)
        return (1 - np.cos(np.pi * (x + 1) / 2)) / 2, w * np.pi * np.sin(np.pi * (x + 1) / 2) / 4

    (p, p_weight), (q, q_weight) = ends(nodes[0]), ends(nodes[1])
    sin_view = np.sqrt((1 - mu) * (1 + mu))
    elevation = np.arctan2(mu, sin_view)
    first, last = elevation / 2, np.pi / 2 - elevation / 2
    total = 0
    for low, high in ((0 * first, first), (first, last)):
        a, b = warp(low)[:, None], warp(high)[:, None]
        theta, density = unwarp(a + (b - a) * p)
        edge = np.full(theta.shape, np.pi)
        if low is first:
            edge = np.arccos(np.clip(-np.tan(elevation)[:, None] / np.tan(2 * theta), -1, 1))
        c, s = np.cos(theta)[..., None], np.sin(theta)[..., None]
        v_dot_h = np.clip(sin_view[:, None, None] * s * np.cos(edge[..., None] * q) + mu[:, None, None] * c, 0, 1)
        light = np.clip(2 * v_dot_h * c - mu[:, None, None], 1e-150, 1)
        weight = (2 * edge * density * p_weight * (b - a))[..., None] * q_weight
        total = total + np.stack([(value * weight).sum((1, 2)) for value in integrand(v_dot_h, light)])
    return total


def ggx(mu, alpha):
    """(white albedo, its part weighted by Schlick's (1 - v·h)^5), shape (2, mu); correlated Smith (Heitz 2014)."""

    def smith(c):
        t = alpha**2 * (1 - c) * (1 + c) / (c * c)
        return t / (np.sqrt(1 + t) + 1) / 2

    def unwarp(w):
        theta = np.arctan2(alpha * np.sin(w), np.cos(w))
        return theta, np.sin(w) * np.cos(w) / (np.pi * np.cos(theta))

    def integrand(v_dot_h, light):
        g = v_dot_h / (1 + smith(mu)[:, None, None] + smith(light)) / mu[:, None, None]
        return g, g * (1 - v_dot_h) ** 5

    return half_vector_quadrature(mu, lambda t: np.arctan2(np.sin(t), alpha * np.cos(t)), unwarp, integrand)


def anisotropic_ggx(view, alpha, nodes=(64, 48)):
    """The same as ggx() for an anisotropic lobe; x, y, z of the view and both alphas have one value each a row.

    It is the mean of G2 / G1 over visible normals (Dupuy and Benyoub 2023): midpoints around, a cosine substitution
    along, which takes the root at the edge. With 64 and 48 nodes it is off by at most 8e-4, with 128 and 96 by 2.4e-4.
    """
    p, weight = np.polynomial.legendre.leggauss(nodes[1])
    weight = weight * np.pi * np.sin(np.pi * (p + 1) / 2) / 4
    p = (1 - np.cos(np.pi * (p + 1) / 2)) / 2
    around = 2 * np.pi * (np.arange(nodes[0])[:, None] + 0.5) / nodes[0]
    result = np.empty((2, len(view[0])))
    for start in range(0, len(view[0]), 256):
        rows = slice(start, start + 256)
        x, y, z, along, across = (v[rows, None, None] for v in (*view, *alpha))
        size = np.sqrt((along * x) ** 2 + (across * y) ** 2 + z * z)
        px, py, pz = along * x / size, across * y / size, z / size
        above = (1 - p) * (1 + pz)
        radius = np.sqrt(p * (1 + pz) * (above + (px * px + py * py) / (1 + pz)))
        hx = along * (radius * np.cos(around) + px)
        hy = across * (radius * np.sin(around) + py)
        scale = 1 / np.sqrt(hx * hx + hy * hy + above * above)
        v_dot_h = (x * hx + y * hy + z * above) * scale
        lx, ly, lz = (2 * v_dot_h * h * scale - v for h, v in ((hx, x), (hy, y), (above, z)))
        light = np.sqrt((along * lx) ** 2 + (across * ly) ** 2 + lz * lz)
        passed = np.where(lz > 0, lz * (z + size) / np.maximum(lz * size + z * light, 1e-300), 0)
        result[0, rows] = passed.mean(1) @ weight
        result[1, rows] = (passed * np.clip(1 - v_dot_h, 0, 1) ** 5).mean(1) @ weight
    return result


def sheen_lambda(x, alpha):
    """Λ of KHR_materials_sheen (Estevez and Kulla 2017)."""
    m = (1 - alpha) ** 2
    ends = ((21.5473, 25.3245), (3.82987, 3.32435), (0.19823, 0.16801), (-1.97760, -1.27393), (-4.32054, -4.85967))
    a, b, c, d, e = (rough + (smooth - rough) * m for rough, smooth in ends)

    def exponent(x):
        return a / (1 + b * x**c) + d * x + e

    return np.exp(np.where(x < 0.5, exponent(x), 2 * exponent(0.5) - exponent(np.maximum(1 - x, 0))))


def sheen(mu, alpha):
    """White albedo of the Charlie lobe, shape (1, mu)."""
    scale = np.sqrt(alpha / 2)  # D falls over this cosine

    def unwarp(w):
        c = np.clip(scale * np.sinh(-w), 0, 1)
        s = np.sqrt((1 - c) * (1 + c))
        return np.arccos(c), (2 + 1 / alpha) * s ** (1 / alpha) * scale * np.cosh(w) / (2 * np.pi)

    def integrand(v_dot_h, light):
        view = sheen_lambda(mu, alpha)[:, None, None]
        return (v_dot_h / (1 + view + sheen_lambda(light, alpha)) / mu[:, None, None],)

    return half_vector_quadrature(mu, lambda t: -np.arcsinh(np.cos(t) / scale), unwarp, integrand)


def grid(truth, alphas, cosines):
    """(alpha, cosine, truth...) as flat arrays"""
    values = np.array([truth(cosines, alpha) for alpha in alphas])
    alpha, mu = np.meshgrid(alphas, cosines, indexing="ij")
    return (alpha.ravel(), mu.ravel(), *(values[:, k].ravel() for k in range(values.shape[1])))


def cosine_nodes(low, n):
    return np.unique(np.concatenate([np.geomspace(low, 1, n // 2).clip(low, 1), np.linspace(low, 1, n // 2)]))


# ---- Fits. Terms are exponents (i, j) of the cosine and of alpha; the sheen's j are of √alpha, the mean loss's i of
# -log2(alpha). The long ones are what is left of all low orders after dropping one after another while the bounds held.

LOSS_N = [(1, 2), (1, 4), (2, 2), (2, 3), (2, 4)]
LOSS_Q = [(0, 3), (0, 4), (0, 5), (0, 6), (1, 2), (1, 3), (2, 1), (2, 2), (2, 4), (3, 0), (3, 1)]
SHIFT_N = [(0, 3), (0, 3.5), (1, 2.5), (1, 3), (3, 2)]
SHIFT_Q = [(0, 2), (0, 2.5), (0, 3.5), (1, 1), (1, 1.5), (2, 0), (2, 0.5)]
SHEEN_N = [(0, 1), (0, 4), (1, 0), (1, 1), (1, 2), (1, 4), (2, 1), (2, 4), (4, 0)]
SHEEN_Q = [(1, 1), (0, 1), (0, 2), (0, 3), (0, 4), (0, 5), (0, 6), (1, 0), (1, 2), (1, 3), (1, 5), (2, 0), (2, 1)]
SHEEN_Q += [(2, 2), (2, 3), (3, 0), (3, 2), (3, 3), (4, 0), (4, 1), (5, 0), (0.5, 1), (0.5, 2)]
# These are the terms of 1 / (cos (1 + Λ)). The j are of (1 - alpha)².
MASKING_N = [(0, 0), (0, 1), (0, 2), (0.5, 0), (0.5, 1), (0.5, 2), (1, 0), (1, 2), (1.5, 0), (2, 1), (3, 0), (3, 1)]
MASKING_Q = [(1, 0), (0, 0), (0, 1), (0, 2), (0.5, 0), (0.5, 1), (0.5, 2), (1, 1), (1, 2), (1.5, 0), (2, 1), (3, 1)]
MASKING_Q += [(3, 2)]
MASKING_CANCEL, SHEEN_CANCEL = 3, 8  # sum of the terms' magnitudes over their sum: the rounding errors that 1 - E shows
SHEEN_ROUND = 4
# -log2((1 + s) / 2), by the odd powers of (1 - s) / (3 + s): the series of the hyperbolic arc tangent, whose last
# constant stands for the rest.
SHEEN_BELL = (2.885390, 0.9617967, 0.64)
MEAN_LOSS_N = [(i, j) for i in (0, 1) for j in (2, 3, 4, 5)]
MEAN_BIAS_N = [(0, j) for j in range(5)]  # of √alpha
MEAN_BIAS_LOW = 0.999  # instead of MEAN_LOW
POLYNOMIAL = [(0, 0)]
# Anisotropic lobes: LIKE is of the alpha of the isotropic lobe that loses about as much. The terms of the factor on its
# loss are exponents of the variables of anisotropic_view().
LIKE = 0.22
# Bounds of loss - truth (above, below, and below it under a cosine of 0.04), and of the weighted part - truth.
ANISO_UNDER, ANISO_OVER, ANISO_GRAZING, ANISO_BIAS_OVER = 1e-3, 8.4e-3, 1.7e-2, 5.5e-2
ANISO_MEAN_LOW, ANISO_MEAN_SLACK = 0.995, 4e-5
ANISO_LOSS = [(0, 0, 0, 0), (0, 0, 1, 1), (0, 0, 2, 0), (0, 0, 3, 0), (0, 0, 4, 0), (0, 1, 0, 1), (0, 1, 0, 2)]
ANISO_LOSS += [(0, 1, 1, 0), (0, 1, 1, 1), (0, 1, 2, 0), (0, 1, 2, 1), (0, 1, 3, 0), (0, 2, 0, 0), (0, 2, 0, 1)]
ANISO_LOSS += [(0, 2, 0, 2), (0, 3, 1, 0), (1, 0, 0, 0), (1, 0, 2, 0), (1, 1, 0, 2), (1, 1, 2, 0), (1, 3, 0, 0)]
ANISO_LOSS += [(2, 0, 0, 0), (2, 0, 0, 1), (2, 0, 0, 2), (2, 0, 1, 0), (2, 0, 1, 1), (2, 1, 1, 0)]
ANISO_LOSS += [(3, 0, 0, 0), (3, 0, 0, 1), (4, 0, 0, 0)]
# Of the factor on the shift of the alpha along the view, which is the second variable; the last is length.
ANISO_BIAS = [(0, 0, 0, 0), (0, 0, 0, 1), (0, 0, 0, 2), (0, 0, 0, 3), (0, 0, 1, 0), (0, 0, 1, 1), (0, 0, 1, 2)]
ANISO_BIAS += [(0, 1, 0, 0), (0, 1, 0, 1), (0, 1, 0, 2), (1, 0, 0, 0), (1, 0, 0, 2), (1, 0, 1, 0), (1, 0, 1, 1)]
ANISO_BIAS += [(1, 0, 2, 0), (1, 1, 0, 1), (1, 2, 0, 0), (2, 0, 0, 0), (2, 0, 0, 1)]
ANISO_MEAN = [(i, j) for i in range(6) for j in range(6) if i + j <= 5]  # of √ of the larger alpha, and of the ratio
ANISO_MEAN_BIAS = [(i, j) for i in range(3) for j in range(3) if i + j <= 2]  # of both alphas


def monomials(variables, exponents):
    """Each product of powers, of whatever shape the variables have"""
    one = variables[0].dtype.type(1)
    return [math.prod((v ** v.dtype.type(k) for v, k in zip(variables, e) if k), start=one) for e in exponents]


def fit(name, variables, numerator, denominator, low, high, factor=1.0, cancel=None):
    """Constants of N and Q with low <= factor N / Q <= high, Q > 0 everywhere: linear programs on growing subsets.

    With cancel, a number or an array, the magnitudes of the terms of either sum add up to at most that many times the
    sum.
    """
    count = len(variables[0])
    terms = [np.stack([m * np.ones(count) for m in monomials(variables, side)], 1) for side in (numerator, denominator)]
    size = terms[1].max(1, keepdims=True)
    n, q = terms[0] / size * np.reshape(factor * np.ones(count), (-1, 1)), terms[1] / size
    rows = np.arange(0, count, max(1, count // 2000))
    for _ in range(12):
        a, b = n[rows], q[rows]
        matrix = np.block([[a, -high[rows, None] * b], [-a, low[rows, None] * b], [0 * a, -b]])
        limits = np.concatenate([np.zeros(2 * len(rows)), -np.ones(len(rows))])
        bounds, cost = (None, None), np.zeros(matrix.shape[1])
        if cancel is not None:
            # Each constant is the difference of two numbers that are not negative.
            sums = np.block([[a, 0 * b], [0 * a, b]])
            times = np.tile(np.broadcast_to(cancel, count)[rows], 2)[:, None]
            matrix = np.block([[matrix, -matrix], [(1 - times) * sums, (1 + times) * sums]])
            limits = np.concatenate([limits, np.zeros(len(sums))])
            column = np.tile(np.abs(sums).max(0), 2)
            matrix, bounds, cost = matrix / column, (0, None), np.ones(len(column))
            matrix[limits == 0] /= np.abs(matrix[limits == 0]).max(1, keepdims=True)
        result = linprog(cost, A_ub=matrix, b_ub=limits, bounds=bounds, method="highs")
        if result.status != 0:
            sys.exit(f"{name}: no such fit: {result.message}")
        solution = result.x
        if cancel is not None:
            solution = solution / column
            solution = solution[: len(solution) // 2] - solution[len(solution) // 2 :]
        constants = solution / solution[len(numerator)]
        value = (n @ constants[: len(numerator)]) / (q @ constants[len(numerator) :])
        broken = np.flatnonzero((value < low - 1e-5) | (value > high + 1e-5) | (q @ solution[len(numerator) :] <= 0))
        if not len(broken):
            break
        rows = np.union1d(rows, broken[:: 1 + len(broken) // 500])
    constants = np.array([float(f"{c:.7g}") for c in constants])
    print(f"{name}:")
    for letter, side, values in (("n", numerator, constants), ("q", denominator, constants[len(numerator) :])):
        print("  " + ", ".join(f"{letter}{'_'.join(f'{k:g}' for k in e)} {c:.7g}" for e, c in zip(side, values)))
    return constants


def polynomial(constants, exponents, variables):
    """The sum of the terms in the precision of the variables."""
    return sum(k * m for k, m in zip(constants.astype(variables[0].dtype), monomials(variables, exponents)))


def rational(constants, numerator, denominator, *variables):
    """N / Q in the precision of the variables."""
    n = polynomial(constants[: len(numerator)], numerator, variables)
    return n / polynomial(constants[len(numerator) :], denominator, variables)


def fitted_ggx(loss, shift, mu, alpha):
    """(1 - white, weighted part) of the fits"""
    lost = rational(loss, LOSS_N, LOSS_Q, mu, alpha)
    m = np.clip(1 - mu - rational(shift, SHIFT_N, SHIFT_Q, mu, alpha), 0, 1)
    return lost, (1 - lost) * m**5


def fit_ggx():
    """(constants of the loss, of the shift) on cosines from 1e-3"""
    alphas = np.union1d(np.geomspace(MIN_ALPHA, 1, 90), np.linspace(0.02, 1, 50))
    alpha, mu, white, weighted = grid(ggx, alphas, cosine_nodes(1e-3, 140))
    truth = 1 - white
    loss = fit("loss", (mu, alpha), LOSS_N, LOSS_Q, np.maximum(truth - 5.8e-3, 0), truth + 1e-4)
    # The rest is in the effective cosine: weighted = white (1 - cosine)^5. For a mirror it is Schlick's to
    # 1e-3.
    kept = 1 - rational(loss, LOSS_N, LOSS_Q, mu, alpha)
    over = np.where(mu > 100 * alpha, 9e-4, 5.75e-3)
    low = 1 - mu - np.minimum((weighted + over) / kept, 1) ** 0.2
    high = np.where(weighted < 1e-4, 5, 1 - mu - (np.maximum(weighted - 1e-4, 0) / kept) ** 0.2)
    return loss, fit("shift", (mu, alpha), SHIFT_N, SHIFT_Q, low, high)


def means(loss, shift, alphas):
    """(mean loss, mean weighted part) of the fits: Gauss in log cosine, as the loss lies about cos = alpha."""
    x, w = np.polynomial.legendre.leggauss(400)
    mu = np.exp((x - 1) / 2 * np.log(1e9))
    weight = w * np.log(1e9) * mu * mu
    lost, bias = fitted_ggx(loss, shift, mu[None], alphas[:, None])
    return lost @ weight, bias @ weight


def fit_means(loss, shift):
    alphas = np.geomspace(MIN_ALPHA, 1, 600)
    lost, bias = means(loss, shift, alphas)
    decades, one = -np.log2(alphas), np.ones(len(alphas))
    mean_loss = fit("mean loss", (decades, alphas), MEAN_LOSS_N, POLYNOMIAL, one / (1 + 2e-4), one / 0.996, 1 / lost)
    bounds = np.maximum(bias - 9e-4, 3e-5), bias + 2.3e-4
    mean_bias = fit("mean bias", (decades, np.sqrt(alphas)), MEAN_BIAS_N, POLYNOMIAL, *bounds)
    return mean_loss, mean_bias


# ---- Anisotropic lobes. The variables are the cosine to the normal and the square of the part along x, both of the view
# whose part along y is shortened by the ratio of the alphas, then the larger alpha and the ratio. If the ratio is 0, the
# loss is a function of the first two and of alpha, because no facet changes the part of a direction along the grooves.


def anisotropic_view(view, alpha):
    """(cosine, squared part along x, the larger alpha, the ratio), and the length of the shortened view"""
    x, y, z = view
    ratio = alpha[1] / alpha[0]
    length = np.sqrt(z * z + x * x + (ratio * y) ** 2)
    return (z / length, (x / length) ** 2, alpha[0] + 0 * z, ratio + 0 * z), length


def like_isotropic(along, ratio):
    """The alpha of the isotropic lobe that loses about as much"""
    return along * (1 - along.dtype.type(LIKE) * (1 - ratio) * np.sqrt(along))


def fitted_anisotropic_loss(loss, aniso, view, alpha):
    variables, _ = anisotropic_view(view, alpha)
    cosine, _, along, ratio = variables
    lost = rational(loss, LOSS_N, LOSS_Q, cosine, like_isotropic(along, ratio))
    return lost * (1 + (1 - ratio) * polynomial(aniso, ANISO_LOSS, variables))


def anisotropic_shift(shift, view, alpha):
    """The isotropic shift, for the alpha along the view"""
    x, y, z = view
    across = np.maximum(x * x + y * y, x.dtype.type(1e-12))
    along = np.sqrt(((alpha[0] * x) ** 2 + (alpha[1] * y) ** 2) / across)
    along = np.clip(along, x.dtype.type(MIN_ALPHA), x.dtype.type(1))
    return along, rational(shift, SHIFT_N, SHIFT_Q, z, along)


def fitted_anisotropic_bias(shift, bias, kept, view, alpha):
    (cosine, _, larger, ratio), length = anisotropic_view(view, alpha)
    along, moved = anisotropic_shift(shift, view, alpha)
    terms = polynomial(bias[:-1], ANISO_BIAS, (cosine, along, ratio, length))
    moved = moved + (1 - ratio) * (moved * terms + bias[-1].astype(larger.dtype) * larger * view[2] * cosine)
    return kept * np.clip(1 - view[2] - moved, 0, 1) ** 5


def anisotropic_samples(seed, count):
    """(view, alpha) as flat arrays: roughness and strength as artists set them, many views near grazing and across"""
    random = np.random.default_rng(seed)
    across = np.maximum(random.random(count) ** 2, MIN_ALPHA)
    strength = random.random(count) ** 0.7
    strength[::7] = 1
    z = np.where(random.random(count) < 0.4, 10 ** random.uniform(-4, 0, count), random.random(count))
    phi = np.pi / 2 * (1 - np.where(random.random(count) < 0.5, random.random(count) ** 2, random.random(count)))
    phi[::6], phi[1::9] = np.pi / 2, 0
    sine = np.sqrt((1 - z) * (1 + z))
    return (sine * np.cos(phi), sine * np.sin(phi), z), (across + (1 - across) * strength**2, across)


def fit_anisotropic(loss, shift):
    """(constants of the loss, of the bias)"""
    view, alpha = anisotropic_samples(7, 36000)
    white, weighted = anisotropic_ggx(view, alpha)
    variables, length = anisotropic_view(view, alpha)
    cosine, _, larger, ratio = variables
    z = view[2]
    base = rational(loss, LOSS_N, LOSS_Q, cosine, like_isotropic(larger, ratio))
    factor = (1 - ratio) * base
    low = np.maximum(1 - white - np.where(z < 0.04, ANISO_GRAZING, ANISO_OVER) + 4e-4, 0)
    high = 1 - white + np.where(z < 0.001, 3e-3, ANISO_UNDER - 2e-4)
    rows = ratio < 0.97  # the rest is the isotropic fit, and has its errors
    chosen = [v[rows] for v in variables]
    bounds = [((v - base) / factor)[rows] for v in (low, high)]
    aniso = fit("anisotropic loss", chosen, ANISO_LOSS, [(0,) * 4], *bounds)[:-1]

    kept = 1 - fitted_anisotropic_loss(loss, aniso, view, alpha)
    along, moved = anisotropic_shift(shift, view, alpha)
    top, bottom = weighted + ANISO_BIAS_OVER - 1e-3, weighted - np.where(z < 2e-3, 4e-3, ANISO_UNDER - 2e-4)
    low = np.where(top >= kept, -5, 1 - np.minimum(top / kept, 1) ** 0.2)
    high = np.where(bottom < 2e-4, 5, 1 - np.clip(bottom / kept, 0, 1) ** 0.2)
    low, high = ((v - z - moved) / (1 - ratio) for v in (low, high))
    variables = [v[rows] for v in (cosine, along, ratio, length, moved, larger * z * cosine)]
    terms = [e + (1, 0) for e in ANISO_BIAS] + [(0, 0, 0, 0, 0, 1)]
    return aniso, fit("anisotropic shift", variables, terms, [(0,) * 6], low[rows], high[rows])[:-1]


def anisotropic_means(loss, shift, aniso, bias, alpha):
    """(mean loss, mean weighted part) of exactly these fits"""
    x, w = np.polynomial.legendre.leggauss(120)
    z = np.exp((x - 1) / 2 * np.log(1e9))
    phi, around = np.polynomial.legendre.leggauss(24)
    phi = np.pi / 4 * (phi + 1)
    weight = (w * np.log(1e9) * z * z)[:, None] * around / 2
    result = []
    for larger, across in zip(*alpha):
        z_, phi_ = np.meshgrid(z, phi, indexing="ij")
        sine = np.sqrt((1 - z_) * (1 + z_))
        view = (sine * np.cos(phi_), sine * np.sin(phi_), z_)
        lost = fitted_anisotropic_loss(loss, aniso, view, (larger, across))
        weighted = fitted_anisotropic_bias(shift, bias, 1 - lost, view, (larger, across))
        result.append(((lost * weight).sum(), (weighted * weight).sum()))
    return np.transpose(result)


def anisotropic_pairs(seed, count):
    random = np.random.default_rng(seed)
    across = np.maximum(random.random(count) ** 2, MIN_ALPHA)
    strength = random.random(count)
    strength[::6], across[::11] = 1, MIN_ALPHA
    return across + (1 - across) * strength**2, across


def fitted_anisotropic_means(mean_loss, aniso_mean, larger, across):
    ratio = across / larger
    like = like_isotropic(larger, ratio)
    lost = rational(mean_loss, MEAN_LOSS_N, POLYNOMIAL, -np.log2(like), like)
    factor = 1 + (1 - ratio) * polynomial(aniso_mean[0], ANISO_MEAN, (np.sqrt(larger), ratio))
    return lost * factor, polynomial(aniso_mean[1], ANISO_MEAN_BIAS, (larger, across))


def fit_anisotropic_means(loss, shift, aniso, bias, mean_loss):
    larger, across = anisotropic_pairs(11, 1500)
    ratio = across / larger
    rows = ratio < 0.97
    larger, across, ratio = larger[rows], across[rows], ratio[rows]
    lost, weighted = anisotropic_means(loss, shift, aniso, bias, (larger, across))
    base = fitted_anisotropic_means(mean_loss, np.zeros((2, 99)), larger, across)[0]
    bounds = lost / (1 + 2e-4), (lost + ANISO_MEAN_SLACK) / (ANISO_MEAN_LOW + 5e-4)
    low, high = ((bound - base) / (base * (1 - ratio)) for bound in bounds)
    return (
        fit("anisotropic mean loss", (np.sqrt(larger), ratio), ANISO_MEAN, POLYNOMIAL, low, high)[:-1],
        fit("anisotropic mean bias", (larger, across), ANISO_MEAN_BIAS, POLYNOMIAL, weighted - 8e-3, weighted)[:-1],
    )


def fitted_masking(masking, mu, alpha):
    t = (1 - alpha) * (1 - alpha)
    return rational(masking, MASKING_N, MASKING_Q, mu, t)


def sheen_bell(mu, alpha):
    """((1 + s) / 2) ** (1 / (2 alpha)), with s = sin² / (sin + SHEEN_ROUND alpha).

    With the sine itself it is D of the most oblique facet that shows light above the horizon, over its largest value.
    Near the normal such facets lie all around, so that the mean is a function of sin². No digits cancel in 1 - s.
    """
    one = mu.dtype.type(1)
    sine = np.sqrt((one - mu) * (one + mu))
    rounding = mu.dtype.type(SHEEN_ROUND) * alpha
    rest = (sine * mu * mu / (one + sine) + rounding) / (sine + rounding)
    z = rest / (4 * one - rest)
    a, b, c = (mu.dtype.type(k) for k in SHEEN_BELL)
    return np.exp2(-z * (a + z * z * (b + c * z * z)) / (2 * alpha))


def fitted_sheen(masking, constants, mu, alpha):
    lit = rational(constants, SHEEN_N, SHEEN_Q, mu, np.sqrt(alpha))
    return sheen_bell(mu, alpha) * np.maximum(lit, 0) * fitted_masking(masking, mu, alpha)


def fit_sheen():
    """(constants of the masking, of the rest). Λ itself is the exponential of a number up to 17, and has as many times
    the rounding errors; the masking is within 0.4% near grazing, and the rest is fitted to what that leaves."""
    cosines = np.unique(np.concatenate([np.geomspace(1e-7, 1, 70), np.linspace(0.01, 1, 30)]))
    alphas = np.unique(np.concatenate([np.geomspace(MIN_SHEEN_ALPHA, 1, 16), np.linspace(0.05, 1, 12)]))
    alpha, mu, truth = grid(lambda c, a: 1 / (c * (1 + sheen_lambda(c, a)))[None], alphas, cosines)
    error = 4e-3 * (1 + np.clip((mu - 0.01) / 0.05, 0, 9)) * truth
    t = (1 - alpha) ** 2
    masking = fit(
        "sheen masking", (mu, t), MASKING_N, MASKING_Q, truth - error, truth + error, cancel=MASKING_CANCEL
    )

    cosines = np.concatenate([np.geomspace(1e-7, 1e-3, 40)[:-1], cosine_nodes(1e-3, 150)])
    alpha, mu, truth = grid(sheen, np.geomspace(MIN_SHEEN_ALPHA, 1, 90), cosines)
    over = np.minimum(0.7275 * SHEEN_RELATIVE * truth, 0.97 * SHEEN_OVER * np.maximum(1, truth))
    # The truth spans thirty decades, so that it is the scale, but where it is too dark to matter.
    scale = np.maximum(truth, 1e-6)
    factor = sheen_bell(mu, alpha) * fitted_masking(masking, mu, alpha) / scale
    high = (truth + over + SHEEN_DARK) / scale
    low = np.maximum((1 - 1e-4) * truth - SHEEN_DARK, 0) / scale
    cancel = np.minimum(np.maximum(SHEEN_CANCEL / truth, SHEEN_CANCEL), 3e3)
    return masking, fit("sheen", (mu, np.sqrt(alpha)), SHEEN_N, SHEEN_Q, low, high, factor, cancel)


# ---- Checks, in single precision


def check(name, values, low, high):
    least, most = float(np.min(values)), float(np.max(values))
    broken = not (least >= low and most <= high)
    print(f"{name:42} {least:10.2e} .. {most:9.2e}  in {low:.2e} .. {high:.2e}{'  BROKEN' if broken else ''}")
    return broken


def check_anisotropic(loss, shift, aniso, bias, mean_loss, aniso_mean):
    view, alpha = anisotropic_samples(23, 20000)
    view, alpha = (tuple(v.astype(np.float32).astype(float) for v in vectors) for vectors in (view, alpha))
    white, weighted = anisotropic_ggx(view, alpha, (128, 96))
    view32, alpha32 = single(*view), single(*alpha)
    lost = fitted_anisotropic_loss(loss, aniso, view32, alpha32)
    lobe = fitted_anisotropic_bias(shift, bias, 1 - lost, view32, alpha32)
    exact = fitted_anisotropic_loss(loss, aniso, view, alpha)
    broken = []
    for place, rows in (("", view[2] >= 0.04), (" below 0.04", view[2] < 0.04)):
        over = ANISO_GRAZING if place else ANISO_OVER
        broken.append(check(f"anisotropic white{place}", (1 - lost - white)[rows], -3e-3, over + 1.2e-3))
        broken.append(check(f"anisotropic weighted{place}", (lobe - weighted)[rows], -7e-3, ANISO_BIAS_OVER + 5e-3))
    broken.append(check("anisotropic loss", lost, 0, 1))
    broken.append(check("anisotropic loss, single precision's error", lost - exact, -1e-6, 1e-6))

    alpha = anisotropic_pairs(31, 400)
    lost, weighted = anisotropic_means(loss, shift, aniso, bias, alpha)
    fitted_loss, fitted_bias = fitted_anisotropic_means(mean_loss, aniso_mean, *alpha)
    broken.append(check("C of the anisotropic loss", lost / fitted_loss, 0, MEAN_HIGH))
    low = (lost + ANISO_MEAN_SLACK) / fitted_loss
    broken.append(check("the same, with a loss of 4e-5 more", low, ANISO_MEAN_LOW, np.inf))
    broken.append(check("C of the anisotropic weighted part", (1 - weighted) / (1 - fitted_bias), MEAN_LOW, MEAN_HIGH))
    return broken


def single(*arrays):
    return [a.astype(np.float32) for a in arrays]


def check_ggx(loss, shift, mean_loss, mean_bias):
    broken = []
    for place, low, n, under, over in (("", 1e-3, 420, UNDER, OVER), (" below 1e-3", 1e-7, 60, 3e-3, 7e-3)):
        cosines = cosine_nodes(low, n) if not place else np.geomspace(low, 1e-3, n)
        alpha, mu, white, weighted = grid(ggx, np.geomspace(MIN_ALPHA, 1, 401), cosines)
        lost, bias = fitted_ggx(loss, shift, *single(mu, alpha))
        broken.append(check(f"white{place}", 1 - lost - white, -under, over))
        broken.append(check(f"weighted{place}", bias - weighted, -under, over))
        broken.append(check(f"weighted over white{place}", bias / (1 - lost), 0, 1))
        broken.append(check(f"loss{place}", lost, 0, 1))
    mu = np.linspace(0.05, 1, 400)
    lost, bias = fitted_ggx(loss, shift, *single(mu, np.full(400, MIN_ALPHA)))
    broken.append(check("mirror: loss", lost, 0, 1e-3))
    broken.append(check("mirror: weighted - Schlick", bias - (1 - mu) ** 5, -1e-3, 1e-3))

    alphas = np.geomspace(MIN_ALPHA, 1, 1499)
    lost, bias = means(loss, shift, alphas)
    decades, alphas = single(-np.log2(alphas), alphas)
    fitted_loss = rational(mean_loss, MEAN_LOSS_N, POLYNOMIAL, decades, alphas)
    fitted_bias = rational(mean_bias, MEAN_BIAS_N, POLYNOMIAL, decades, np.sqrt(alphas))
    broken.append(check("C of the loss", lost / fitted_loss, MEAN_LOW, MEAN_HIGH))
    broken.append(check("C of the weighted part", (1 - bias) / (1 - fitted_bias), MEAN_BIAS_LOW, MEAN_HIGH))
    return broken


def check_sheen(masking, constants):
    cosines = np.concatenate([np.geomspace(1e-7, 1e-3, 60)[:-1], cosine_nodes(1e-3, 420)])
    alpha, mu, truth = grid(sheen, np.geomspace(MIN_SHEEN_ALPHA, 1, 401), cosines)
    fitted = fitted_sheen(masking, constants, *single(mu, alpha))
    rounding = fitted - fitted_sheen(masking, constants, *(v.astype(float) for v in single(mu, alpha)))
    usual = mu >= 1e-4  # nearer to grazing, the lobe's own Λ is too small
    sane = alpha[usual & (truth > 1)].max()
    print(f"sheen from cosine 1e-4: at most {truth[usual].max():.4f}; at most 1 above alpha {sane:.4f}")
    print(f"sheen above alpha {sane:.4f}: above 1 up to cosine {mu[(alpha > sane) & (truth > 1)].max():.1e}")
    return [
        check("sheen, over max(1, truth)", (fitted - truth) / np.maximum(1, truth), -SHEEN_UNDER, SHEEN_OVER),
        check("sheen, over truth", (fitted - truth - SHEEN_DARK) / np.maximum(truth, 1e-6), -np.inf, SHEEN_RELATIVE),
        check("sheen, single precision's error", rounding / np.maximum(1, truth), -9e-7, 9e-7),
    ]


def main():
    # The exact value is known: white = 1 - cos ln(1 + 1 / cos) at alpha = 1.
    mu = np.geomspace(1e-3, 1, 50)
    broken = [check("quadrature at alpha 1", ggx(mu, 1.0)[0] - (1 - mu * np.log1p(1 / mu)), -5e-5, 5e-5)]
    loss, shift = fit_ggx()
    mean_loss, mean_bias = fit_means(loss, shift)
    masking, constants = fit_sheen()
    aniso, bias = fit_anisotropic(loss, shift)
    aniso_mean = fit_anisotropic_means(loss, shift, aniso, bias, mean_loss)
    broken += check_anisotropic(loss, shift, aniso, bias, mean_loss, aniso_mean)
    broken += check_ggx(loss, shift, mean_loss, mean_bias) + check_sheen(masking, constants)
    sys.exit(any(broken))


if __name__ == "__main__":
    main()
