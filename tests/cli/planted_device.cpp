#include "cli/planted_device.h"

namespace glint::testing {

nlohmann::json plantedDevice(const std::string& fastest) {
    using Json = nlohmann::json;
    Json strategies = Json::array();
    for (const char* const strategy : {"uber", "sorted-uber", "visibility", "hit-shaders"}) {
        const double factor = strategy == fastest ? 1.0 : 10.0;
        const bool ordered = strategy == std::string("sorted-uber") || strategy == std::string("visibility");
        Json constants{{"launchesMs", 0.01 * factor},
                       {"raysNs", 1.0 * factor},
                       {"incoherenceNs", 0.5 * factor},
                       {"instructionsPs", 0.2 * factor}};
        if (ordered) {
            constants["casesMs"] = 0.001 * factor;
            constants["bucketsNs"] = 0.02 * factor;
        } else {
            constants["divergencePs"] = 0.2 * factor;
            constants["missesPs"] = 0.0;
        }
        if (strategy != std::string("visibility")) {
            constants["codePs"] = 0.001 * factor;
        }
        strategies.push_back({{"strategy", strategy}, {"constants", constants}, {"fit", nullptr}});
    }
    return {{"format", "glint-device"},
            {"version", 1},
            {"device", "Planted"},
            {"driver", "Planted 1.0"},
            {"deviceType", "gpu"},
            {"subgroupSize", 32},
            {"tracer", "ray-query"},
            {"shadows", "inline"},
            {"command", "none"},
            {"strategies", strategies},
            {"regret",
             {{"heldOut", true},
              {"points", 0},
              {"median", 0.0},
              {"worst", 0.0},
              {"withinFivePercent", 0.0},
              {"worstPoint", nullptr}}}};
}

}  // namespace glint::testing
