// The instances of a scene's TLAS, and the rules by which it is updated or built anew.
#pragma once

#include "context/context.h"
#include "data/motion_bounds.h"
#include "data/traversal_order.h"
#include "scene/record_store.h"

#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace glint {

// Each instance is named by its first geometry record, which is its custom index. A change of one takes
// constant time. Only a build on a driver that wants an order (leafOrderFor()) visits all of them.
class TopLevel {
public:
    // `updatable`: the TLAS may be updated, else it is built anew after each change.
    TopLevel(bool updatable, LeafOrder order)
        : updatable_(updatable), order_(order), records_(sizeof(VkAccelerationStructureInstanceKHR)) {}

    // Adds or replaces an instance. `box` is around it in the scene's space.
    void set(const VkAccelerationStructureInstanceKHR& instance, const Box& box);
    // Removes an instance, if it is there.
    void remove(std::uint32_t geometry);

    // Decides what the next recording does. `blasChanged` says whether a BLAS of some instance was built or
    // refitted. An update keeps the tree of the last build. So the TLAS is built anew if instances came or
    // went, if one has left its place (hasLeft()), and after kMaxRefits updates; docs/movement.md has the
    // measurements. `builds` overrules all but the first of these.
    BuildAction next(bool blasChanged, MotionView::Builds builds) const;
    // Puts the instances into their order if they are built anew.
    void prepare(BuildAction action);
    // Notes that the action is recorded.
    void apply(BuildAction action);

    bool isUpdatable() const {
        return updatable_;
    }
    // The array of VkAccelerationStructureInstanceKHR that the TLAS is built from.
    RecordArray& records() {
        return records_;
    }
    const RecordArray& records() const {
        return records_;
    }

private:
    bool keepsBoxes() const {
        return updatable_ || order_ != nullptr;
    }
    void setBox(std::uint32_t place, const Box& box);
    void takeBoxes();  // into built_

    bool updatable_;
    LeafOrder order_;
    RecordArray records_;
    std::unordered_map<std::uint32_t, std::uint32_t> places_;  // by custom index
    std::vector<Box> boxes_;                                   // by place; empty unless keepsBoxes()
    std::vector<Box> built_;              // the same at the last build; empty unless the TLAS is updatable
    std::vector<std::uint32_t> touched_;  // places whose boxes may differ from `built_`
    std::uint32_t updates_ = 0;
    bool restructured_ = true;
    bool changed_ = false;
    bool left_ = false;
};

}  // namespace glint
