#!/usr/bin/env python3
"""Fits ggxDirectionalAlbedo() of shaders/bsdf/fresnel.glsl and prints its constants and errors. Needs NumPy.

Reference: quadrature over visible normals (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps",
2023) of the single-scatter lobe with height-correlated Smith shadowing.
"""
import numpy as np


def albedo(alpha, mu, n=128):
    """(albedo of a white lobe, the part of it that Schlick's (1 - v·h)^5 weights)"""
    mid = (np.arange(n) + 0.5) / n
    u, phi = np.meshgrid(mid, 2 * np.pi * mid)
    view = np.array([np.sqrt(1 - mu * mu), 0, mu])
    stretched = np.array([alpha * view[0], 0, view[2]])
    stretched /= np.linalg.norm(stretched)
    z = (1 - u) * (1 + stretched[2]) - stretched[2]
    s = np.sqrt(np.clip(1 - z * z, 0, 1))
    half = np.stack([s * np.cos(phi) + stretched[0], s * np.sin(phi), z + stretched[2]])
    half = np.stack([alpha * half[0], alpha * half[1], np.maximum(half[2], 1e-12)])
    half /= np.linalg.norm(half, axis=0)
    v_dot_h = half[0] * view[0] + half[2] * view[2]
    light_z = 2 * v_dot_h * half[2] - view[2]
    above = light_z > 0
    light_z = np.where(above, light_z, 1.0)

    def smith(c):
        return (np.sqrt(1 + alpha**2 * (1 / c**2 - 1)) - 1) / 2

    g = np.where(above, (1 + smith(mu)) / (1 + smith(mu) + smith(light_z)), 0)
    return g.mean(), (g * np.clip(1 - v_dot_h, 0, 1) ** 5).mean()


def main():
    roughness = np.linspace(0, 1, 33)[1:]
    cosine = np.concatenate([[0.02, 0.05], np.linspace(0.08, 1, 24)])
    table = np.array([[albedo(max(r * r, 1e-4), m) for m in cosine] for r in roughness])
    white, weighted = table[:, :, 0], table[:, :, 1]
    r, m = np.meshgrid(roughness, cosine, indexing="ij")

    terms = np.stack([(r ** (i + 1) * np.sqrt(m) ** j).ravel() for i in range(3) for j in range(3)], 1)
    constants, *_ = np.linalg.lstsq(terms, (1 - white).ravel(), rcond=None)
    error = terms @ constants - (1 - white).ravel()
    print("loss: r^(i+1) sqrt(mu)^j, i major:", np.round(constants, 4).tolist())
    print(f"  largest error {np.abs(error).max():.3f}, RMS {np.sqrt((error**2).mean()):.3f}")

    best = (np.inf,)
    for a in np.arange(1, 4.01, 0.25):
        for b in np.arange(1, 30, 0.5):
            fit = (1 - m) ** (5 * np.exp(-a * r)) / (1 + b * r * r)
            best = min(best, (np.abs(fit - weighted).max(), a, b, np.sqrt(((fit - weighted) ** 2).mean())))
    print(f"bias: a = {best[1]}, b = {best[2]}: largest error {best[0]:.3f}, RMS {best[3]:.3f}")


if __name__ == "__main__":
    main()
