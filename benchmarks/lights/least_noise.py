#!/usr/bin/env python3
"""Estimates the noise of choosing lights that is left if only shadows are unknown.

    benchmarks/lights/least_noise.py [--counts 64 512 4096] [--samples 1 8] [--points N]

The scene is that of benchmarks/measure_lights.py. At points of its floor, which is taken for diffuse, lights are chosen
with a probability in exact proportion to the irradiance that each would bring without shadows; samples are stratified
over the lights in the order of a Morton curve. With many more lights than samples, better hierarchies and the
resampling of candidates tend to this noise. With few lights, more even probabilities have less, because the samples
then see nearly all lights. Prints Markdown: the share of the light that arrives, and the mean over the points of the
variance of a sample over the square of its mean plus 0.01, which is the relMse of measure_lights.py. Needs
python3-numpy, and no device.
"""
import argparse
import pathlib
import random
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from measure_lights import floor_with_boxes, light_field  # noqa: E402

LUMINANCE = numpy.array([0.2126, 0.7152, 0.0722])
REFLECTED = 0.7 / numpy.pi  # of the scene's material, without its highlight
LEAST_SQUARE = 0.01  # what relMse adds to the square of the reference


def boxes_of(corners):
    """The boxes on the floor, which come after it, as their lower and upper corners."""
    places = numpy.array([place for place, _ in corners]).reshape(-1, 36, 3)[1:]
    return places.min(axis=1), places.max(axis=1)


def morton_order(places):
    codes = numpy.zeros(len(places), dtype=numpy.int64)
    cells = ((places - places.min(axis=0)) / numpy.ptp(places, axis=0) * 1023).astype(numpy.int64)
    for bit in range(10):
        for axis in range(3):
            codes |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return numpy.argsort(codes)


def variance(probabilities, values, samples):
    """The variance of the mean of stratified samples, of which each has a share of the probability."""
    ends = numpy.cumsum(probabilities) / probabilities.sum()
    starts = numpy.concatenate([[0.0], ends[:-1]])
    weights = numpy.where(probabilities > 0, values / numpy.maximum(probabilities / probabilities.sum(), 1e-30), 0)
    total = 0.0
    for i in range(samples):
        overlap = numpy.clip(numpy.minimum(ends, (i + 1) / samples) - numpy.maximum(starts, i / samples), 0, None)
        share = overlap * samples
        total += (share * weights**2).sum() - (share * weights).sum() ** 2
    return total / samples**2


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--counts", type=int, nargs="+", default=[64, 512, 4096])
    parser.add_argument("--samples", type=int, nargs="+", default=[1, 8])
    parser.add_argument("--points", type=int, default=400)
    options = parser.parse_args()
    print("| lights | light that arrives | " + " | ".join(f"relMse, K = {k}" for k in options.samples) + " |")
    print("|--:|--:|" + "--:|" * len(options.samples))
    for count in options.counts:
        generator = random.Random(1)
        lower, upper = boxes_of(floor_with_boxes(generator))
        lights = light_field(generator, count)
        places = numpy.array([place for place, _, _ in lights])
        intensities = numpy.array([intensity * (LUMINANCE @ color) for _, intensity, color in lights])
        order = morton_order(places)
        points = numpy.random.default_rng(2).uniform([-9, 0, -9], [9, 0, 6], (options.points, 3))
        free = ~((points[:, None, [0, 2]] > lower[:, [0, 2]]) & (points[:, None, [0, 2]] < upper[:, [0, 2]])).all(
            axis=2).any(axis=1)
        arriving, errors = [], []
        for point in points[free]:
            way = places - point
            squared = (way**2).sum(axis=1)
            bare = REFLECTED * intensities * way[:, 1] / squared**1.5
            with numpy.errstate(divide="ignore", invalid="ignore"):
                near = (lower[:, None] - point) / way
                far = (upper[:, None] - point) / way
            enters = numpy.minimum(near, far).max(axis=2)
            leaves = numpy.maximum(near, far).min(axis=2)
            blocked = ((enters < leaves) & (leaves > 1e-6) & (enters < 1)).any(axis=0)
            seen = numpy.where(blocked, 0.0, bare)
            arriving.append(seen.sum() / bare.sum())
            square = seen.sum() ** 2 + LEAST_SQUARE
            errors.append([variance(bare[order], seen[order], k) / square for k in options.samples])
        print(f"| {count:,} | {100 * numpy.mean(arriving):.0f} % | " +
              " | ".join(f"{error:.3g}" for error in numpy.mean(errors, axis=0)) + " |")


if __name__ == "__main__":
    main()
