#include "unit/image/flip_oracle.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace glint::testing {

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Triple {
    double a, b, c;
};

// The matrix of IEC 61966-2-1 to seven digits, and the solution of its three equations by Cramer's rule.
constexpr double kXyz[3][3] = {
    {0.4123908, 0.3575843, 0.1804808}, {0.2126390, 0.7151687, 0.0721923}, {0.0193308, 0.1191948, 0.9505322}};

double determinant(const double (&m)[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

// Returns X, Y and Z relative to those of white.
Triple toXyz(const Triple& rgb) {
    double xyz[3];
    for (int i = 0; i < 3; ++i) {
        const double white = kXyz[i][0] + kXyz[i][1] + kXyz[i][2];
        xyz[i] = (kXyz[i][0] * rgb.a + kXyz[i][1] * rgb.b + kXyz[i][2] * rgb.c) / white;
    }
    return {xyz[0], xyz[1], xyz[2]};
}

Triple fromXyz(const Triple& relative) {
    const double values[3] = {relative.a, relative.b, relative.c};
    double rgb[3];
    for (int column = 0; column < 3; ++column) {
        double replaced[3][3];
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                const double white = kXyz[i][0] + kXyz[i][1] + kXyz[i][2];
                replaced[i][j] = j == column ? values[i] * white : kXyz[i][j];
            }
        }
        rgb[column] = determinant(replaced) / determinant(kXyz);
    }
    return {rgb[0], rgb[1], rgb[2]};
}

Triple toLab(const Triple& rgb) {
    const auto f = [](double t) {
        return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
    };
    const Triple xyz = toXyz(rgb);
    const double lightness = 116.0 * f(xyz.b) - 16.0;
    return {lightness, lightness / 100.0 * 500.0 * (f(xyz.a) - f(xyz.b)),
            lightness / 100.0 * 200.0 * (f(xyz.b) - f(xyz.c))};
}

double hyab(const Triple& p, const Triple& q) {
    return std::abs(p.a - q.a) + std::sqrt((p.b - q.b) * (p.b - q.b) + (p.c - q.c) * (p.c - q.c));
}

// A picture of one channel that continues beyond its borders.
struct Channel {
    int width, height;
    std::vector<double> values;
    [[nodiscard]] double at(int x, int y) const {
        return values[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) *
                          static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
    }
};

// Returns the weight of a filter x pixels right and y down.
using Weight = std::function<double(double x, double y)>;

// Both signs are normalised: weights above 0 sum to 1, those below to -1.
Channel convolve(const Channel& in, int radius, const Weight& weight) {
    double above = 0.0;
    double below = 0.0;
    for (int j = -radius; j <= radius; ++j) {
        for (int i = -radius; i <= radius; ++i) {
            const double w = weight(i, j);
            (w > 0.0 ? above : below) += std::abs(w);
        }
    }
    Channel out{in.width, in.height, {}};
    for (int y = 0; y < in.height; ++y) {
        for (int x = 0; x < in.width; ++x) {
            double sum = 0.0;
            for (int j = -radius; j <= radius; ++j) {
                for (int i = -radius; i <= radius; ++i) {
                    const double w = weight(i, j);
                    sum += in.at(x + i, y + j) * (w > 0.0 ? w / above : w < 0.0 ? w / below : 0.0);
                }
            }
            out.values.push_back(sum);
        }
    }
    return out;
}

struct Seen {
    std::vector<Triple> lab;
    std::vector<double> edges, points;
};

std::vector<double> lengths(const Channel& x, const Channel& y) {
    std::vector<double> result;
    for (std::size_t i = 0; i < x.values.size(); ++i) {
        result.push_back(std::hypot(x.values[i], y.values[i]));
    }
    return result;
}

Seen look(const LinearImage& image, double perDegree) {
    const int width = static_cast<int>(image.width);
    const int height = static_cast<int>(image.height);
    Channel luma{width, height, {}};
    Channel redGreen = luma;
    Channel blueYellow = luma;
    Channel grey = luma;
    for (const std::array<float, 4>& pixel : image.pixels) {
        const Triple xyz = toXyz({pixel[0], pixel[1], pixel[2]});
        luma.values.push_back(116.0 * xyz.b - 16.0);
        redGreen.values.push_back(500.0 * (xyz.a - xyz.b));
        blueYellow.values.push_back(200.0 * (xyz.b - xyz.c));
        grey.values.push_back(xyz.b);
    }

    const auto sensitivity = [perDegree](double a1, double b1, double a2, double b2) -> Weight {
        return [=](double x, double y) {
            const double d2 = (x * x + y * y) / (perDegree * perDegree);
            return a1 * std::sqrt(kPi / b1) * std::exp(-kPi * kPi * d2 / b1) +
                   a2 * std::sqrt(kPi / b2) * std::exp(-kPi * kPi * d2 / b2);
        };
    };
    const int eye = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * perDegree));
    luma = convolve(luma, eye, sensitivity(1.0, 0.0047, 0.0, 1e-5));
    redGreen = convolve(redGreen, eye, sensitivity(1.0, 0.0053, 0.0, 1e-5));
    blueYellow = convolve(blueYellow, eye, sensitivity(34.1, 0.04, 13.5, 0.025));

    Seen seen;
    for (std::size_t i = 0; i < luma.values.size(); ++i) {
        const double y = (luma.values[i] + 16.0) / 116.0;
        Triple rgb = fromXyz({y + redGreen.values[i] / 500.0, y, y - blueYellow.values[i] / 200.0});
        rgb = {std::clamp(rgb.a, 0.0, 1.0), std::clamp(rgb.b, 0.0, 1.0), std::clamp(rgb.c, 0.0, 1.0)};
        seen.lab.push_back(toLab(rgb));
    }

    const double s = 0.5 * 0.082 * perDegree;
    const int reach = static_cast<int>(std::ceil(3.0 * s));
    const auto bell = [s](double x, double y) { return std::exp(-(x * x + y * y) / (2.0 * s * s)); };
    const Weight edge = [=](double x, double y) { return -x * bell(x, y); };
    const Weight point = [=](double x, double y) { return (x * x / (s * s) - 1.0) * bell(x, y); };
    const auto turned = [](const Weight& weight) -> Weight {
        return [weight](double x, double y) { return weight(y, x); };
    };
    seen.edges = lengths(convolve(grey, reach, edge), convolve(grey, reach, turned(edge)));
    seen.points = lengths(convolve(grey, reach, point), convolve(grey, reach, turned(point)));
    return seen;
}

}  // namespace

std::vector<double> plainFlip(const LinearImage& image, const LinearImage& reference,
                              double pixelsPerDegree) {
    const Seen a = look(image, pixelsPerDegree);
    const Seen b = look(reference, pixelsPerDegree);
    const double largest = std::pow(hyab(toLab({0, 1, 0}), toLab({0, 0, 1})), 0.7);
    std::vector<double> map;
    for (std::size_t i = 0; i < a.lab.size(); ++i) {
        const double difference = std::pow(hyab(a.lab[i], b.lab[i]), 0.7) / largest;
        const double color =
            difference < 0.4 ? difference / 0.4 * 0.95 : 0.95 + (difference - 0.4) / 0.6 * 0.05;
        const double feature =
            std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
        map.push_back(std::pow(color, 1.0 - std::sqrt(feature / std::sqrt(2.0))));
    }
    return map;
}

}  // namespace glint::testing
