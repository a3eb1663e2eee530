#!/usr/bin/env python3
"""Fits the model behind `--lights auto` (tool/resolve/light.h), and writes tool/plan/light_constants.h.

    benchmarks/lights/fit_light_costs.py [--check]

benchmarks/measure_lights.py makes the measurements in benchmarks/data/lights, two for each scene: model_* has several
numbers of samples, and default_* has pictures of one sample with the effects of the default. The times are those of
default_*, fitted for each scene by least squares of relative errors, without constants below zero. The noise is that of
model_*, fitted by least squares of logarithms, and its constants are the means over the scenes. The header says how far
off the fit is. --check writes nothing, and exits with 1 if the header is not what the measurements give. Needs
python3-numpy.
"""
import argparse
import json
import math
import pathlib
import statistics
import sys

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "benchmarks/data/lights"
HEADER = ROOT / "tool/plan/light_constants.h"
SCENES = ("clearcoat", "floor")
MOST = 16  # samples; with 32, each takes 1.3 times as long on the measured device
FEW = 16  # lights; with more, single pixels that show a light in a clear coat decide the mean error of a picture


def not_negative(rows, values):
    """Least squares without constants below zero: those are left out, the most negative first."""
    kept = list(range(rows.shape[1]))
    while True:
        found = numpy.linalg.lstsq(rows[:, kept], values, rcond=None)[0]
        if (found >= 0).all():
            result = numpy.zeros(rows.shape[1])
            result[kept] = found
            return result
        kept.pop(int(found.argmin()))


def read(path):
    """The report, and its rows as numbers: lights, samples or 0 for all, and the row."""
    report = json.loads(path.read_text(encoding="utf-8"))
    rows = [(row["lights"], 0 if row["choice"] == "all" else int(row["choice"]), row) for row in report["results"]
            if "before" not in row["choice"]]
    return report, [row for row in rows if row[1] <= MOST]


class Scene:
    """A scene's measurements, and the constants that fit them."""

    def __init__(self, name):
        report, rows = read(DATA / f"default_{name}.json")
        self.name, self.device = report["scene"], report["device"]
        width, height = map(int, report["size"].split("x"))
        self.timed = [(lights, samples, 1e6 * statistics.median(row["frameMilliseconds"]) / (width * height))
                      for lights, samples, row in rows]
        self.error = statistics.median(row["errorOfSample"] for lights, samples, row in rows
                                       if samples == 0 and lights <= FEW)
        self.noisy = [(lights, samples, row["relMseOfSample"])
                      for lights, samples, row in read(DATA / f"model_{name}.json")[1] if 0 < samples < lights]
        self.times = self.fit_times()
        self.noises = self.fit_noise()

    def fit_times(self):
        rows = numpy.array([[1, lights if samples == 0 else 0, samples, samples * math.log2(lights)]
                            for lights, samples, _ in self.timed], dtype=float)
        times = numpy.array([time for *_, time in self.timed])
        return not_negative(rows / times[:, None], numpy.ones(len(times)))

    def fit_noise(self):
        rows = numpy.array([[1, math.log(lights), math.log(1 - samples / lights), -math.log(samples)]
                            for lights, samples, _ in self.noisy])
        return numpy.linalg.lstsq(rows, numpy.log([noise for *_, noise in self.noisy]), rcond=None)[0]

    def time(self, lights, samples):
        rest, light, sample, level = self.times
        return rest + (light * lights if samples == 0 else samples * (sample + level * math.log2(lights)))

    def noise(self, lights, samples):
        return math.exp(self.noises @ [1, math.log(lights), math.log(1 - samples / lights), -math.log(samples)])

    def comment(self):
        """How far off the fit is."""
        times = [abs(self.time(lights, samples) / time - 1) for lights, samples, time in self.timed]
        noises = [abs(math.log(self.noise(lights, samples) / noise)) for lights, samples, noise in self.noisy]
        return (f"// {self.name}, {self.device}: times off by {100 * statistics.median(times):.1f} % "
                f"(median), {100 * max(times):.1f} % at most;\n//     noise by a factor of "
                f"{math.exp(statistics.median(noises)):.2f} (median), {math.exp(max(noises)):.2f} at most")


def number(value):
    return f"{float(f'{value:.3g}')!r}"


def header(scenes):
    noise, of_lights, of_rest, of_samples = numpy.mean([scene.noises for scene in scenes], axis=0)
    pixel_error = statistics.geometric_mean(scene.error for scene in scenes)
    lines = ["// clang-format off",
             "// Made by benchmarks/lights/fit_light_costs.py from benchmarks/data/lights; run it again rather than edit "
             "this.", "//",
             *(scene.comment() for scene in scenes),
             "#pragma once", "", "#include <cstdint>", "", "namespace glint::compiler::fitted {", "",
             "// In nanoseconds of a sample of a pixel.",
             "struct LightTimes {",
             "    double rest;    // without lights",
             "    double light;   // each light, where all are taken",
             "    double sample;  // each sample of the hierarchy",
             "    double level;   // the same for each doubling of the lights",
             "};",
             "inline constexpr LightTimes kLightScenes[] = {",
             *(f"    {{{', '.join(number(time) for time in scene.times)}}},  // {scene.name}" for scene in scenes),
             "};", "",
             "// With 32 samples, each takes 1.3 times as long.",
             f"inline constexpr std::uint32_t kLightSamples = {MOST};", "",
             "// The relMse of a sample of a pixel with all lights.",
             f"inline constexpr double kPixelError = {number(pixel_error)};", "",
             "// The relMse that K samples of n lights add: kNoise n^kNoiseOfLights (1 - K/n)^kNoiseOfRest / "
             "K^kNoiseOfSamples.",
             f"inline constexpr double kNoise = {number(math.exp(noise))};",
             f"inline constexpr double kNoiseOfLights = {number(of_lights)};",
             f"inline constexpr double kNoiseOfRest = {number(of_rest)};",
             f"inline constexpr double kNoiseOfSamples = {number(of_samples)};", "",
             "}  // namespace glint::compiler::fitted", ""]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    text = header([Scene(name) for name in SCENES])
    if options.check:
        if HEADER.read_text(encoding="utf-8") != text:
            sys.exit(f"{HEADER} is not what the measurements give; run benchmarks/lights/fit_light_costs.py")
    else:
        HEADER.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
