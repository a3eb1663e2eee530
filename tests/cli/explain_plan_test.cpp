// Tests explain --plan: what it prints for people, and that its JSON agrees with the package.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

class ExplainPlan : public TinySceneTest {
protected:
    Outcome explain(const std::vector<std::string>& more) const {
        return runWith({"explain", scene_, "--plan"}, more);
    }
};

TEST_F(ExplainPlan, JsonHasEveryCaseAndItsCost) {
    const Outcome outcome = must(explain({"--merge", "all", "--json"}));
    EXPECT_EQ(outcome.json().at("merge"), "all");
    EXPECT_FALSE(outcome.json().contains("materials"));
    const Json plan = outcome.json().at("plan");
    EXPECT_TRUE(plan.at("maxShaders").is_null());
    EXPECT_EQ(plan.at("hits"), "expected");
    EXPECT_EQ(plan.at("keys"), 2);
    ASSERT_EQ(plan.at("cases").size(), 1U);
    const Json shared = plan.at("cases")[0];
    EXPECT_EQ(shared.at("reason"), "all");
    EXPECT_EQ(shared.at("keys").size(), 2U);
    EXPECT_EQ(shared.at("sometimes"), Json({"unlit", "normals"}));
    EXPECT_EQ(shared.at("estimate").at("lobeBranches"), 1);
    EXPECT_EQ(shared.at("estimate").at("inputBranches"), 1);
    EXPECT_TRUE(shared.at("nearest").is_null());
    EXPECT_EQ(shared.at("spared"), plan.at("caseCost"));
    // Waiting for the lit code costs unlit hits more than the branch on normals.
    EXPECT_EQ(shared.at("branches")[0].at("feature"), "unlit");
    EXPECT_GT(shared.at("inVain").get<double>(), shared.at("spared").get<double>());
    for (const Json& key : shared.at("keys")) {
        EXPECT_LT(key.at("leavingAdds").get<double>(), 0.0);
    }
    EXPECT_EQ(shared.at("keys")[0].at("materials")[0].at("name"), "Wall");
    EXPECT_NEAR(plan.at("cost").get<double>(),
                plan.at("inVain").get<double>() + plan.at("caseCost").get<double>(), 1e-9);
}

TEST_F(ExplainPlan, ComparesOtherCases) {
    for (const char* merge : {"auto", "family"}) {
        const Json plan = explain({"--merge", merge, "--json"}).json().at("plan");
        std::vector<std::string> names;
        int chosen = 0;
        for (const Json& other : plan.at("merges")) {
            names.push_back(other.at("name"));
            chosen += other.at("chosen").get<bool>() ? 1 : 0;
            EXPECT_EQ(other.at("milliseconds").size(), 4U);
            for (const Json& milliseconds : other.at("milliseconds")) {
                EXPECT_GE(milliseconds, other.at("firstHitsMilliseconds"));
            }
            if (other.at("chosen").get<bool>() && std::string(merge) == "auto") {
                EXPECT_EQ(other.at("cases"), plan.at("cases").size());
                EXPECT_EQ(other.at("inVain"), plan.at("inVain"));
            }
        }
        EXPECT_EQ(chosen, 1);
        EXPECT_EQ(names, (std::vector<std::string>{"none", "all"}));
    }
    // With room for one case there is no choice.
    const Json tight = explain({"--merge", "auto", "--max-shaders", "1", "--json"}).json().at("plan");
    EXPECT_EQ(tight.at("maxShaders"), 1);
    EXPECT_EQ(tight.at("cases")[0].at("reason"), "budget");
    EXPECT_EQ(tight.at("merges").size(), 1U);
}

// The model is fitted to shaders like these, so it must be near them.
TEST_F(ExplainPlan, EstimatesAreNearWhatIsCompiled) {
    for (const char* merge : {"none", "all"}) {
        const Json cases = explain({"--merge", merge, "--json"}).json().at("plan").at("cases");
        const Outcome compiled = must(run(
            {"compile", scene_, "-o", "package", "--merge", merge, "--strategy", "visibility", "--json"}));
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const Json code = compiled.json().at("shaders")[i].at("stages").at("visibility");
            const Json estimate = cases[i].at("estimate");
            EXPECT_NEAR(estimate.at("instructions").get<double>() / code.at("instructions").get<double>(),
                        1.0, 0.25)
                << merge;
            EXPECT_EQ(estimate.at("textureFetches"), code.at("textureFetches"));
        }
    }
}

TEST_F(ExplainPlan, TextSaysWhatEachCaseCostsAndWhy) {
    const Outcome apart = must(explain({"--merge", "none"}));
    EXPECT_NE(apart.out.find("scene.gltf: 2 keys in 2 cases, --merge none; hits expected from areas"),
              std::string::npos)
        << apart.out;
    expectFitsTerminal(apart.out);
    EXPECT_NE(apart.out.find("what merging with the nearest case would cost"), std::string::npos);
    const Outcome shared = explain({"--merge", "auto", "--max-shaders", "1", "--verbose"});
    EXPECT_NE(shared.out.find("why          budget: more cases than --max-shaders allows would be better"),
              std::string::npos)
        << shared.out;
    EXPECT_NE(shared.out.find("(1 case fewer)"), std::string::npos) << shared.out;
    EXPECT_NE(shared.out.find("apart it would spare"), std::string::npos) << shared.out;
    EXPECT_NE(shared.out.find("Other cases for the same keys"), std::string::npos) << shared.out;
}

TEST_F(ExplainPlan, ExcludesOneMaterial) {
    const Outcome outcome = explain({"--material", "Floor"});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_NE(outcome.err.find("--material"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace glint::testing
