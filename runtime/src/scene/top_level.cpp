#include "scene/top_level.h"

#include "context/parallel.h"

#include <cstring>

namespace glint {
namespace {

using Instance = VkAccelerationStructureInstanceKHR;

bool isSame(const Instance& a, const Instance& b) {
    // Floats count by their bits. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// An update may change transforms alone.
bool isMoved(const Instance& before, Instance after) {
    after.transform = before.transform;
    return isSame(before, after);
}

}  // namespace

void TopLevel::set(const Instance& instance, const Box& box) {
    const auto [place, added] = places_.try_emplace(instance.instanceCustomIndex, records_.count());
    if (added) {
        records_.write(place->second, instance);
        if (keepsBoxes()) {
            boxes_.push_back(box);
        }
        restructured_ = true;
        return;
    }
    if (keepsBoxes()) {
        boxes_[place->second] = box;
    }
    const auto before = records_.read<Instance>(place->second);
    if (isSame(before, instance)) {
        return;
    }
    restructured_ = restructured_ || !isMoved(before, instance);
    left_ = left_ || (updatable_ && !restructured_ && hasLeft(built_[place->second], box));
    changed_ = true;
    records_.write(place->second, instance);
}

void TopLevel::remove(std::uint32_t geometry) {
    const auto place = places_.find(geometry);
    if (place == places_.end()) {
        return;
    }
    const std::uint32_t last = records_.count() - 1;
    if (place->second != last) {
        const auto moved = records_.read<Instance>(last);
        records_.write(place->second, moved);
        places_[moved.instanceCustomIndex] = place->second;
        if (keepsBoxes()) {
            boxes_[place->second] = boxes_[last];
        }
    }
    if (keepsBoxes()) {
        boxes_.pop_back();
    }
    records_.shrink(last);
    places_.erase(place);
    restructured_ = true;
}

BuildAction TopLevel::next(bool blasChanged, MotionView::Builds builds) const {
    if (!restructured_ && !changed_ && !blasChanged) {
        return BuildAction::Keep;
    }
    if (!updatable_ || restructured_) {
        return BuildAction::Build;
    }
    const bool worn = left_ || updates_ >= kMaxRefits;
    const bool builtAnew =
        builds == MotionView::Builds::ByRule ? worn : builds == MotionView::Builds::Rebuild;
    return builtAnew ? BuildAction::Build : BuildAction::Refit;
}

void TopLevel::apply(BuildAction action) {
    if (action == BuildAction::Build) {
        if (updatable_) {
            built_ = boxes_;
        }
        updates_ = 0;
        left_ = false;
    } else if (action == BuildAction::Refit) {
        ++updates_;
    }
    restructured_ = false;
    changed_ = false;
}

void TopLevel::prepare(BuildAction action) {
    if (action != BuildAction::Build || order_ == nullptr) {
        return;
    }
    std::vector<LeafBox> leaves(boxes_.begin(), boxes_.end());
    const std::vector<std::uint32_t> order = order_(leaves, threadsOfMachine());
    std::vector<Instance> instances;
    instances.reserve(order.size());
    for (const std::uint32_t place : order) {
        instances.push_back(records_.read<Instance>(place));
        places_[instances.back().instanceCustomIndex] = static_cast<std::uint32_t>(instances.size() - 1);
    }
    records_.replace(instances);
    boxes_ = permuted<Box>(boxes_, order);
}

}  // namespace glint
