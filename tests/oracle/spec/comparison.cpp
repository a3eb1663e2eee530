#include "oracle/spec/comparison.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace glint::spec {
namespace {

// The part of `whole` that a change is, in the channel where it is largest.
double largestShare(const Vec3& change, const Vec3& whole) {
    double share = 0.0;
    for (int i = 0; i < 3; ++i) {
        if (whole[i] > 1e-3 * largest(whole) && std::abs(change[i] / whole[i]) > std::abs(share)) {
            share = change[i] / whole[i];
        }
    }
    return share;
}

// Sums over the views of a row.
class Sums {
public:
    void add(Zone zone, const Measured& device, const Vec3& plain, const Vec3& stated) {
        const auto index = static_cast<std::size_t>(zone);
        for (Seen* seen : {&whole_, &zones_[index]}) {
            seen->device += device.mean;
            seen->error += device.error * device.error;  // its square, until the end
            seen->plain += plain;
            seen->stated += stated;
        }
        ++counts_[index];
        fromPlain_ += glm::abs(device.mean - plain);
        fromStated_ += glm::abs(device.mean - stated);
    }

    void finish(Comparison& result) const {
        const int views = counts_[0] + counts_[1] + counts_[2];
        result.whole = mean(whole_, views);
        for (std::size_t i = 0; i < 3; ++i) {
            result.zones[i] = mean(zones_[i], counts_[i]);
        }
        result.viewsOfZone = counts_;
        result.relativeDifference = largestShare(fromPlain_, whole_.plain);
        result.statedDifference = largestShare(fromStated_, whole_.stated);
    }

private:
    static Seen mean(const Seen& sums, int count) {
        const double n = std::max(count, 1);
        return {sums.device / n, glm::sqrt(sums.error) / n, sums.plain / n, sums.stated / n};
    }

    Seen whole_;
    std::array<Seen, 3> zones_;
    std::array<int, 3> counts_{};
    Vec3 fromPlain_{0.0};
    Vec3 fromStated_{0.0};
};

// What is stated about a lobe's light, where the result differs from the specification's.
struct Statement {
    const char* lobe;
    Vec3 Terms::*term;
    const char* traced;
    const char* untraced;
};
constexpr const char* kViewAlbedo = "diffuse light is weighed by the albedo of the view";
constexpr Statement kStatements[] = {
    {"specular", &Terms::specular,
     "mirrors below roughness 0.05; a film at the angle of the view; sheen weighed at the view",
     "the map's mean over a lobe seen head on"},
    {"multiple", &Terms::multiple, "later bounces, by the map's mean", "later bounces, by the map's mean"},
    {"diffuse", &Terms::diffuse, kViewAlbedo,
     "nine harmonics; diffuse light is weighed by the albedo of the view"},
    {"diffuse transmission", &Terms::diffuseTransmitted, kViewAlbedo,
     "nine harmonics; diffuse light is weighed by the albedo of the view"},
    {"transmission", &Terms::transmitted, "sheen and film at the angle of the view",
     "the map's mean about the refracted view; nothing is lost at later bounces"},
    {"sheen", &Terms::sheen, "the lobe's albedo times nine harmonics",
     "the lobe's albedo times nine harmonics"},
    {"clearcoat", &Terms::coat, "mirrors below roughness 0.05",
     "the map's mean over a lobe seen head on; no loss by single scattering"},
};

constexpr const char* kMasking = "height-correlated masking";

void append(std::vector<Approximation>& list, const char* what, double share, const char* why) {
    if (std::abs(share) >= 0.005) {
        list.push_back({what, share, why});
    }
}

// `correlated` is the specification's light with height-correlated masking.
std::vector<Approximation> approximationsOf(const Terms& plain, const Terms& correlated, const Terms& stated,
                                            Lighting lighting) {
    const Vec3 whole = plain.sum();
    std::vector<Approximation> list;
    append(list, kMasking, largestShare(correlated.sum() - whole, whole), "");
    for (const Statement& statement : kStatements) {
        append(list, statement.lobe, largestShare(stated.*statement.term - correlated.*statement.term, whole),
               lighting == Lighting::Untraced ? statement.untraced : statement.traced);
    }
    return list;
}

// The choices that change a BSDF itself, one at a time.
struct NamedChoice {
    const char* name;
    void (*choose)(Choices& choices, const Choices& stated);
};
constexpr NamedChoice kNamedChoices[] = {
    {"energy compensation",
     [](Choices& choices, const Choices& stated) { choices.compensation = stated.compensation; }},
    {"film at the angle of the view",
     [](Choices& choices, const Choices& stated) { choices.iridescenceAtView = stated.iridescenceAtView; }},
    {"sheen divided by its albedo where that exceeds 1, roughness at least 0.07",
     [](Choices& choices, const Choices& stated) { choices.sheenBounded = stated.sheenBounded; }},
    {"diffuse transmission by the Fresnel of the view",
     [](Choices& choices, const Choices& stated) { choices.transmittedAtView = stated.transmittedAtView; }},
    {kMasking, [](Choices& choices, const Choices& stated) { choices.masking = stated.masking; }},
};
using ChoiceSums = std::array<Vec3, std::size(kNamedChoices)>;

std::vector<Approximation> choicesOf(const ChoiceSums& alone, const Vec3& plain) {
    std::vector<Approximation> list;
    for (std::size_t i = 0; i < alone.size(); ++i) {
        append(list, kNamedChoices[i].name, largestShare(alone[i] - plain, plain), "");
    }
    return list;
}

Point pointOf(std::size_t row, const View& view) {
    const Plane plane = planeOf(row);
    return {plane.frame, plane.frame * view.local};
}

}  // namespace

double farthestRatio(const Vec3& numerator, const Vec3& denominator) {
    const double brightest = std::max(largest(numerator), largest(denominator));
    double farthest = 1.0;
    for (int i = 0; i < 3; ++i) {
        if (denominator[i] <= 1e-3 * brightest) {
            continue;
        }
        const double ratio = numerator[i] / denominator[i];
        if (std::abs(ratio - 1.0) > std::abs(farthest - 1.0) || std::isnan(ratio)) {
            farthest = ratio;
        }
    }
    return farthest;
}

double Comparison::ratio() const {
    return farthestRatio(whole.device, whole.plain);
}

double Comparison::predictedRatio() const {
    return farthestRatio(whole.stated, whole.plain);
}

double Comparison::statedRatio() const {
    return farthestRatio(whole.device, whole.stated);
}

double Comparison::noise() const {
    double most = 0.0;
    for (int i = 0; i < 3; ++i) {
        if (whole.stated[i] > 1e-3 * largest(whole.stated)) {
            most = std::max(most, 4.0 * whole.error[i] / whole.stated[i]);
        }
    }
    return most;
}

Comparer::Comparer(const Rows& rows, const ComparisonOptions& options)
    : rows_(rows), options_(options), device_(rows, options.device) {}

const Comparer::LoadedMap& Comparer::mapOf(MapKind kind) {
    LoadedMap& loaded = maps_[kind];
    if (!loaded.map) {
        loaded.map =
            std::make_unique<Map>(options_.mapWidth, options_.mapWidth / 2,
                                  [&](const Vec3& direction) { return radianceOf(kind, direction); });
        loaded.harmonics = std::make_unique<Harmonics>(*loaded.map);
        loaded.environment = Device::makeEnvironment(*loaded.map);
    }
    return loaded;
}

Choices Comparer::plainChoices() const {
    Choices choices;
    choices.masking = options_.masking;
    return choices;
}

Choices Comparer::statedChoices() const {
    Choices choices;
    choices.compensation = options_.device.compensation;
    choices.iridescenceAtView = true;
    choices.sheenBounded = true;
    choices.transmittedAtView = true;
    return choices;
}

bool Comparer::losesByDesign(const Row& row, Transport transport) const {
    const Material m = readMaterial(row.material, rows_.texels);
    const bool glass = m.transmission > 0.0 && m.roughness > 0.05 && !options_.device.compensation;
    const bool coat = m.clearcoat > 0.0 && m.clearcoatRoughness > 0.05 && !options_.device.compensation;
    return transport == Transport::Traced && (glass || coat);
}

Comparison Comparer::start(std::size_t row) const {
    Comparison result;
    result.group = rows_.rows[row].group;
    result.name = rows_.rows[row].name;
    result.white = rows_.rows[row].white;
    result.compensation = options_.device.compensation;
    return result;
}

Comparison Comparer::underLights(std::size_t row) {
    Comparison result = start(row);
    const LoadedMap& any = mapOf(MapKind::White);
    const Material material = readMaterial(rows_.rows[row].material, rows_.texels);
    const std::vector<Light> lights = lightsOfScene();
    Sums sums;
    ChoiceSums alone{};
    Vec3 specification(0.0);
    for (const View& view : viewsOf(options_.manyViews)) {
        if (!faces(material, view)) {
            continue;
        }
        const Point point = pointOf(row, view);
        const Surface plain(material, plainChoices(), albedos_, point);
        specification += plain.underLights(lights);
        for (std::size_t i = 0; i < alone.size(); ++i) {
            Choices choices = plainChoices();
            kNamedChoices[i].choose(choices, statedChoices());
            alone[i] += Surface(material, choices, albedos_, point).underLights(lights);
        }
        const Surface stated(material, statedChoices(), albedos_, point);
        sums.add(view.zone, device_.underLights(row, view, *any.environment), plain.underLights(lights),
                 stated.underLights(lights));
    }
    sums.finish(result);
    result.approximations = choicesOf(alone, specification);
    return result;
}

Comparison Comparer::underMap(std::size_t row, MapKind kind, Transport transport) {
    Comparison result = start(row);
    result.map = kind;
    result.lighting = transport == Transport::Traced ? Lighting::Traced : Lighting::Untraced;
    result.losesByDesign = losesByDesign(rows_.rows[row], transport);
    const LoadedMap& loaded = mapOf(kind);
    const Material material = readMaterial(rows_.rows[row].material, rows_.texels);
    Choices choices = statedChoices();
    choices.sheenAtView = true;
    Choices specification = plainChoices();
    choices.absorbsAlongRays = specification.absorbsAlongRays = transport == Transport::Traced;
    const Surface::Sky sky{*loaded.map, *loaded.harmonics,
                           static_cast<int>(loaded.environment->statistics().levels), transport};
    Sums sums;
    Choices correlated = specification;
    correlated.masking = Masking::HeightCorrelated;
    const bool separable = options_.masking == Masking::Separable;
    Terms plainTerms;
    Terms correlatedTerms;
    Terms statedTerms;
    for (const View& view : viewsOf(options_.manyViews)) {
        if (!faces(material, view)) {
            continue;
        }
        const Point point = pointOf(row, view);
        Terms plain =
            Surface(material, specification, albedos_, point).underMap(*loaded.map, {options_.quality});
        Terms stated = Surface(material, choices, albedos_, point).underSky(sky, {options_.quality});
        Terms same =
            separable
                ? Surface(material, correlated, albedos_, point).underMap(*loaded.map, {options_.quality})
                : plain;
        // The device's picture has lost its emission with the lights'.
        plain.emission = same.emission = stated.emission = Vec3(0.0);
        plainTerms += plain;
        correlatedTerms += same;
        statedTerms += stated;
        sums.add(view.zone, device_.underMap(row, view, *loaded.environment, transport), plain.sum(),
                 stated.sum());
    }
    sums.finish(result);
    result.approximations = approximationsOf(plainTerms, correlatedTerms, statedTerms, result.lighting);
    return result;
}

Comparison Comparer::inFurnaceOnSphere(std::size_t row, Transport transport) {
    Comparison result = start(row);
    result.group = "sphere";
    result.lighting = transport == Transport::Traced ? Lighting::Traced : Lighting::Untraced;
    result.losesByDesign = losesByDesign(rows_.rows[row], transport);
    const auto zones = device_.onSphere(row, *mapOf(MapKind::White).environment, transport);
    Sums sums;
    for (const Zone zone : {Zone::Steep, Zone::Middle, Zone::Grazing}) {
        sums.add(zone, zones[static_cast<std::size_t>(zone)], Vec3(1.0), Vec3(1.0));
    }
    sums.finish(result);
    if (result.losesByDesign) {
        append(result.approximations, "a rough coat scatters light once; the plane has the integral",
               result.ratio() - 1.0, "");
    }
    return result;
}

}  // namespace glint::spec
