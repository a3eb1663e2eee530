// bench_traversal measures rays per second on the first Vulkan device by the order of triangles and
// instances, for scenes as they are and shuffled. It compares them with Embree, which traces the same rays
// with as many threads. Each round measures everything once, one after the other, so that other work on the
// machine slows all alike.
#include "context/context.h"
#include "data/traversal_order.h"
#include "emit/compile.h"
#include "gltf/import.h"
#include "oracle/traversal/orders.h"
#include "oracle/traversal/trace_kernel.h"
#include "resolve/resolve.h"
#include "support/halved_tree.h"
#include "support/quantile.h"

#include <glint/session/camera.h>
#include <glint/session/scene_view.h>
#include <glint/session/session.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <thread>

namespace {

using namespace glint;
using namespace glint::traversal;
using Json = nlohmann::json;

struct Arguments {
    std::vector<std::string> scenes;
    std::int64_t rounds = 7;
    double runMs = 60.0;
    std::string json;
    std::string markdown;
};

// An order of a scene's leaves to measure.
struct Variant {
    const char* name;
    bool shuffled;
    SceneView::TraversalOrder order;
    LeafOrder leaves;  // null: the driver's order, halvingOrder()
    // Triangles and instances are ordered, but each mesh has one BLAS with its geometries in sequence.
    bool wholeMeshes = false;
};

constexpr Variant kVariants[] = {
    {"input", false, SceneView::TraversalOrder::Input, nullptr},
    {"Morton", false, SceneView::TraversalOrder::Halving, mortonOrder},
    {"SAH", false, SceneView::TraversalOrder::Halving, sahOrder},
    {"halving", false, SceneView::TraversalOrder::Halving, nullptr},
    {"halving, whole meshes", false, SceneView::TraversalOrder::Input, nullptr, true},
    {"shuffled, input", true, SceneView::TraversalOrder::Input, nullptr},
    {"shuffled, Morton", true, SceneView::TraversalOrder::Halving, mortonOrder},
    {"shuffled, SAH", true, SceneView::TraversalOrder::Halving, sahOrder},
    {"shuffled, halving", true, SceneView::TraversalOrder::Halving, nullptr}};
constexpr std::size_t kHalving = 3;
constexpr const char* kEmbree = "Embree";

// Puts indices and instances into a random order. Afterwards spans of `data` point to them.
struct Shuffled {
    explicit Shuffled(session::SceneViewData& data) {
        std::mt19937_64 random(3);
        for (PrimitiveView& primitive : data.primitives) {
            std::vector<std::array<std::uint32_t, 3>> triangles;
            for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
                triangles.push_back(
                    {primitive.indices[i], primitive.indices[i + 1], primitive.indices[i + 2]});
            }
            std::ranges::shuffle(triangles, random);
            std::vector<std::uint32_t>& own = indices.emplace_back();
            for (const auto& corners : triangles) {
                own.insert(own.end(), corners.begin(), corners.end());
            }
        }
        for (std::size_t i = 0; i < indices.size(); ++i) {
            data.primitives[i].indices = indices[i];
        }
        std::ranges::shuffle(data.instances, random);
    }
    std::vector<std::vector<std::uint32_t>> indices;
};

// Orders the triangles of each primitive, and the instances by their meshes, as the driver's order does, but
// without a BLAS for each geometry.
struct OrderedMeshes {
    explicit OrderedMeshes(const session::SceneViewData& data)
        : primitives(data.primitives),
          instances(data.instances),
          indices(orderedTriangles(data.primitives, {std::uint64_t{1} << 24U, 1}, halvingOrder)) {
        std::vector<LeafBox> leaves;
        for (const InstanceView& instance : instances) {
            Box box = Box::nothing();
            const PrimitiveRange own = primitivesOf(primitives, instance.mesh);
            for (std::uint32_t i = own.first; i < own.end; ++i) {
                box.extend(boxOf(primitives[i], primitives[i].indices));
            }
            leaves.emplace_back(transformed(box, instance.objectToWorld));
        }
        instances = permuted<InstanceView>(instances, halvingOrder(leaves, 1));
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            primitives[i].indices = indices[i];
        }
    }
    std::vector<PrimitiveView> primitives;
    std::vector<InstanceView> instances;
    std::vector<std::vector<std::uint32_t>> indices;
};

// How many rays a run traces, and the rays per second of each round.
struct Runs {
    std::size_t rays = 0;
    std::vector<double> rates;
};

// The measurements of one scene. The maps have the variant's name as key; `runs` has camera rays, then
// bounces.
struct Measured {
    std::string name;
    std::size_t triangles = 0;  // over all instances
    std::size_t instances = 0;
    std::map<std::string, std::array<Runs, 2>> runs;
    std::map<std::string, double> orderMs;
    std::map<std::string, double> costs;  // halvedTreeCost() of the primitive with the most triangles
    double unlike = 0.0;  // share of the rays for which device and Embree differ by more than 1 %

    // Returns rays per second, round by round, for as many camera rays as bounces.
    std::vector<double> rates(const std::string& variant) const {
        std::vector<double> both;
        const auto& [camera, bounces] = runs.at(variant);
        for (std::size_t i = 0; i < camera.rates.size(); ++i) {
            both.push_back(2.0 / (1.0 / camera.rates[i] + 1.0 / bounces.rates[i]));
        }
        return both;
    }
    double rate(const std::string& variant) const {
        return test::quantile(rates(variant), 0.5);
    }
    // Returns the ratio of the two rates in each round.
    std::vector<double> ratios(const std::string& of, const std::string& to) const {
        std::vector<double> result = rates(of);
        const std::vector<double> base = rates(to);
        std::ranges::transform(result, base, result.begin(), std::divides());
        return result;
    }
};

// Returns the cost of the driver's tree over the primitive with the most triangles.
double costOf(const session::SceneViewData& data, const Variant& variant) {
    const auto largest = std::ranges::max_element(
        data.primitives, {}, [](const PrimitiveView& primitive) { return primitive.indices.size(); });
    std::vector<LeafBox> leaves(largest->indices.size() / 3);
    for (std::size_t i = 0; i < 3 * leaves.size(); ++i) {
        leaves[i / 3].extend(largest->positions[largest->indices[i]]);
    }
    const bool isInput = variant.order == SceneView::TraversalOrder::Input && !variant.wholeMeshes;
    const LeafOrder order = isInput ? inputOrder : variant.leaves != nullptr ? variant.leaves : halvingOrder;
    return test::halvedTreeCost(leaves, order(leaves, 1));
}

// Compiles as little as possible, because the scene is only uploaded.
Result<std::shared_ptr<const Package>> packageOf(const gltf::Scene& scene) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.plan.maxShaders = 1;
    return session::compileAndLoad(*compiler::resolve(std::span(&scene, 1), settings));
}

class SceneBench {
public:
    SceneBench(Context& context, const Arguments& arguments) : context_(context), arguments_(arguments) {}

    // Returns nothing if the scene has no triangles that a ray could meet.
    Result<std::optional<Measured>> run(const std::filesystem::path& file) {
        gltf::ImportOptions import;
        import.decodeImages = true;
        GLINT_TRY(const auto scene, gltf::importScene(file, import));
        session::SceneViewData data = session::makeSceneView(scene);
        for (InstanceView& instance : data.instances) {
            instance.joints = {};
            instance.morphWeights = {};
        }
        const std::vector<Triangle> triangles = worldTriangles(data.view());
        if (triangles.empty()) {
            return std::optional<Measured>();
        }
        const EmbreeScene embree(triangles);
        GLINT_TRY(const auto camera, session::chooseCamera(scene, data, "auto", 16.0 / 9.0));
        rays_[0] = cameraRays(camera.view, 640, 360);
        rays_[1] = embree.bounces(rays_[0]);
        if (rays_[1].size() < kTile) {
            return std::optional<Measured>();
        }
        Measured measured;
        measured.name = file.parent_path().filename().string();
        measured.triangles = triangles.size();
        measured.instances = data.instances.size();
        GLINT_TRY_DO(upload(scene, data, measured));
        GLINT_TRY_DO(measure(embree, measured));
        scenes_.clear();
        return std::optional<Measured>(std::move(measured));
    }

private:
    Status upload(const gltf::Scene& scene, session::SceneViewData& data, Measured& measured) {
        GLINT_TRY(const auto package, packageOf(scene));
        scenes_.clear();
        std::optional<Shuffled> shuffled;
        for (const Variant& variant : kVariants) {
            if (variant.shuffled && !shuffled) {
                shuffled.emplace(data);
            }
            data.traversalOrder = variant.order;
            context_.state().leafOrder = variant.leaves;
            SceneView view = data.view();
            std::optional<OrderedMeshes> ordered;
            if (variant.wholeMeshes) {
                ordered.emplace(data);
                view.primitives = ordered->primitives;
                view.instances = ordered->instances;
            }
            GLINT_TRY(auto uploaded, GpuScene::upload(context_, *package, view));
            measured.costs[variant.name] = costOf(data, variant);
            measured.orderMs[variant.name] = uploaded->statistics().orderMs;
            scenes_.push_back(std::move(uploaded));
        }
        GLINT_TRY(kernel_, TraceKernel::create(context_, scenes_.front()->state().setLayout.get(),
                                               std::max(rays_[0].size(), rays_[1].size())));
        return okStatus();
    }

    // Returns milliseconds for the first `count` rays of a kind. A null `scene` selects Embree.
    Result<double> trace(const EmbreeScene& embree, GpuScene* scene, std::size_t kind, std::size_t count) {
        const std::span<const Ray> rays = std::span(rays_[kind]).first(count);
        if (scene != nullptr) {
            return kernel_->trace(*scene, rays);
        }
        distances_.resize(count);
        return embree.trace(rays, distances_);
    }

    Status measure(const EmbreeScene& embree, Measured& measured) {
        const auto run = [&](const char* name, GpuScene* scene, bool first) -> Status {
            for (std::size_t kind = 0; kind < rays_.size(); ++kind) {
                Runs& runs = measured.runs[name][kind];
                if (first) {
                    // Chooses as many rays as take the time of a run, because slow orders would take minutes
                    // otherwise.
                    runs.rays = std::min<std::size_t>(rays_[kind].size(), 16 * kTile);
                    for (int i = 0; i < 3; ++i) {
                        GLINT_TRY(const auto ms, trace(embree, scene, kind, runs.rays));
                        const double wanted = static_cast<double>(runs.rays) * arguments_.runMs / ms;
                        runs.rays = std::clamp<std::size_t>(static_cast<std::size_t>(wanted), 4 * kTile,
                                                            rays_[kind].size());
                    }
                    continue;
                }
                GLINT_TRY(const auto ms, trace(embree, scene, kind, runs.rays));
                runs.rates.push_back(1e3 * static_cast<double>(runs.rays) / ms);
            }
            return okStatus();
        };
        for (std::int64_t round = -1; round < arguments_.rounds; ++round) {
            for (std::size_t i = 0; i < scenes_.size(); ++i) {
                GLINT_TRY_DO(run(kVariants[i].name, scenes_[i].get(), round < 0));
            }
            GLINT_TRY_DO(run(kEmbree, nullptr, round < 0));
        }
        return compare(embree, measured);
    }

    // Checks that both find the same hits. Otherwise the figures would compare different work.
    Status compare(const EmbreeScene& embree, Measured& measured) {
        std::size_t unlike = 0;
        std::size_t count = 0;
        for (const std::vector<Ray>& all : rays_) {
            const std::span<const Ray> rays =
                std::span(all).first(std::min<std::size_t>(all.size(), 128 * kTile));
            distances_.resize(rays.size());
            embree.trace(rays, distances_);
            if (const Result<double> ms = kernel_->trace(*scenes_[kHalving], rays); !ms) {
                return ms.error();
            }
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const float found = kernel_->distances()[i];
                unlike += std::abs(found - distances_[i]) > 0.01F * std::abs(distances_[i]) ? 1 : 0;
            }
            count += rays.size();
        }
        measured.unlike = static_cast<double>(unlike) / static_cast<double>(count);
        return okStatus();
    }

    Context& context_;
    const Arguments& arguments_;
    std::array<std::vector<Ray>, 2> rays_;
    std::vector<std::unique_ptr<GpuScene>> scenes_;  // in the order of kVariants
    std::unique_ptr<TraceKernel> kernel_;
    std::vector<float> distances_;
};

std::string thousands(double rate) {
    return fmt::format("{:.0f}", rate / 1e3);
}

std::string spread(const std::vector<double>& values) {
    return fmt::format("{:.2f} ({:.2f} to {:.2f})", test::quantile(values, 0.5), test::quantile(values, 0.25),
                       test::quantile(values, 0.75));
}

std::string head(const Context& context, const Arguments& arguments) {
    std::string text = fmt::format(
        "{}, {}; {} threads; {} rounds. Rates are medians, in thousands of rays per second. Ratios are "
        "medians "
        "of the rounds' ratios, with quartiles.\n\n| scene | triangles | instances |",
        context.deviceName(), context.driverName(), std::thread::hardware_concurrency(), arguments.rounds);
    std::string rule = "|---|---|---|";
    for (const Variant& variant : kVariants) {
        text += fmt::format(" {} |", variant.name);
        rule += "---|";
    }
    return text +
           " Embree | halving / input | halving: shuffled / not shuffled | halving / Embree | sorting, ms "
           "|\n" +
           rule + "---|---|---|---|---|\n";
}

std::string row(const Measured& measured) {
    std::string text = fmt::format("| {} | {} | {} |", measured.name, measured.triangles, measured.instances);
    for (const Variant& variant : kVariants) {
        text += fmt::format(" {} |", thousands(measured.rate(variant.name)));
    }
    return text + fmt::format(" {} | {} | {} | {} | {:.1f} |\n", thousands(measured.rate(kEmbree)),
                              spread(measured.ratios("halving", "input")),
                              spread(measured.ratios("shuffled, halving", "halving")),
                              spread(measured.ratios("halving", kEmbree)), measured.orderMs.at("halving"));
}

// Summarises each variant: the slowest scene, and the geometric mean of the ratios to the order of the input.
std::string summary(const std::vector<Measured>& all) {
    std::string text =
        "\nGeometric means over all scenes. *tree* is the surface of all nodes and leaves in the tree of the "
        "largest primitive.\n\n"
        "| order | slowest scene, thousands of rays/s | rays / input | rays / Embree | tree / input | "
        "sorting, "
        "ms |\n"
        "|---|---|---|---|---|---|\n";
    for (const Variant& variant : kVariants) {
        double least = std::numeric_limits<double>::infinity();
        double toInput = 0.0;
        double toEmbree = 0.0;
        double tree = 0.0;
        double orderMs = 0.0;
        std::string slowest;
        for (const Measured& measured : all) {
            const double rate = measured.rate(variant.name);
            if (rate < least) {
                least = rate;
                slowest = measured.name;
            }
            toInput += std::log(test::quantile(measured.ratios(variant.name, "input"), 0.5));
            toEmbree += std::log(test::quantile(measured.ratios(variant.name, kEmbree), 0.5));
            tree += std::log(measured.costs.at(variant.name) / measured.costs.at("input"));
            orderMs += measured.orderMs.at(variant.name);
        }
        const auto count = static_cast<double>(all.size());
        text += fmt::format("| {} | {} ({}) | {:.2f} | {:.3f} | {:.2f} | {} |\n", variant.name,
                            thousands(least), slowest, std::exp(toInput / count), std::exp(toEmbree / count),
                            std::exp(tree / count), orderMs > 0.0 ? fmt::format("{:.0f}", orderMs) : "-");
    }
    return text;
}

Json toJson(const Measured& measured) {
    Json variants = Json::array();
    for (const auto& [name, kinds] : measured.runs) {
        Json entry{{"variant", name}};
        for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
            const std::vector<double>& rates = kinds[kind].rates;
            entry[kind == 0 ? "camera" : "bounces"] = {{"rays", kinds[kind].rays},
                                                       {"median", test::quantile(rates, 0.5)},
                                                       {"low", test::quantile(rates, 0.25)},
                                                       {"high", test::quantile(rates, 0.75)}};
        }
        if (const auto order = measured.orderMs.find(name); order != measured.orderMs.end()) {
            entry["orderMs"] = order->second;
            entry["treeCost"] = measured.costs.at(name);
        }
        variants.push_back(entry);
    }
    return {{"scene", measured.name},
            {"triangles", measured.triangles},
            {"instances", measured.instances},
            {"unlike", measured.unlike},
            {"variants", variants}};
}

Status benchAll(const Arguments& arguments) {
    GLINT_TRY(const auto context, Context::createHeadless());
    SceneBench bench(*context, arguments);
    std::vector<Measured> all;
    std::string markdown = head(*context, arguments);
    fmt::print("{}", markdown);
    Json report{{"device", context->deviceName()},
                {"driver", context->driverName()},
                {"threads", std::thread::hardware_concurrency()},
                {"rounds", arguments.rounds},
                {"unit", "rays a second"},
                {"scenes", Json::array()}};
    for (const std::string& scene : arguments.scenes) {
        Result<std::optional<Measured>> measured = bench.run(scene);
        if (!measured) {
            std::fprintf(stderr, "%s: left out: %s\n", scene.c_str(), toString(measured.error()).c_str());
            continue;
        }
        if (!*measured) {
            std::fprintf(stderr, "%s: left out: no ray meets a triangle\n", scene.c_str());
            continue;
        }
        if ((*measured)->unlike > 0.01) {
            std::fprintf(stderr, "%s: device and Embree disagree on %.1f %% of the rays\n", scene.c_str(),
                         100.0 * (*measured)->unlike);
        }
        const std::string text = row(**measured);
        fmt::print("{}", text);
        std::fflush(stdout);
        markdown += text;
        report["scenes"].push_back(toJson(**measured));
        all.push_back(std::move(**measured));
    }
    if (all.empty()) {
        return makeError("bench", "", "no scene was measured", "give scenes, or set GLINT_MODELS");
    }
    const std::string text = summary(all);
    fmt::print("{}", text);
    if (!arguments.markdown.empty()) {
        std::ofstream(arguments.markdown) << markdown << text;
    }
    if (!arguments.json.empty()) {
        std::ofstream(arguments.json) << report.dump(1) << "\n";
    }
    return okStatus();
}

// Returns every .gltf and .glb in the folders of features/ and large/.
std::vector<std::string> scenesOf(const std::filesystem::path& models) {
    std::vector<std::string> found;
    for (const char* const group : {"features", "large"}) {
        const std::filesystem::path folder = models / group;
        if (!std::filesystem::is_directory(folder)) {
            continue;
        }
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            const std::string extension = entry.path().extension().string();
            if (extension == ".gltf" || extension == ".glb") {
                found.push_back(entry.path().string());
            }
        }
    }
    std::ranges::sort(found);
    return found;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        Arguments arguments;
        CLI::App app("Rays a second by the order of triangles and instances; prints Markdown.");
        app.add_option("SCENE", arguments.scenes,
                       "Scenes; default: all of the folder GLINT_MODELS, else of ../shared/models");
        app.add_option("--rounds", arguments.rounds, "Rounds")
            ->check(CLI::Range(1, 1000))
            ->capture_default_str();
        app.add_option("--run-ms", arguments.runMs, "Milliseconds of a run, about")
            ->check(CLI::Range(1, 10000))
            ->capture_default_str();
        app.add_option("--json", arguments.json, "Also writes this file, with camera rays and bounces apart");
        app.add_option("--markdown", arguments.markdown, "Also writes the tables into this file");
        CLI11_PARSE(app, argc, argv);
        if (arguments.scenes.empty()) {
            const char* const models = std::getenv("GLINT_MODELS");
            arguments.scenes = scenesOf(models != nullptr ? models : "../shared/models");
        }
        if (const Status status = benchAll(arguments); !status) {
            std::fprintf(stderr, "%s\n", toString(status.error()).c_str());
            return 1;
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_traversal: %s\n", error.what());
        return 1;
    }
    return 0;
}
