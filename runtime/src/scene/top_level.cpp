#include "scene/top_level.h"

#include "context/parallel.h"

#include <algorithm>
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

void TopLevel::setBox(std::uint32_t place, const Box& box) {
    if (!keepsBoxes()) {
        return;
    }
    boxes_.resize(std::max<std::size_t>(boxes_.size(), place + std::size_t{1}));
    boxes_[place] = box;
    // With one place more than there are boxes all of them are taken over.
    if (updatable_ && touched_.size() <= boxes_.size()) {
        touched_.push_back(place);
    }
}

void TopLevel::set(const Instance& instance, const Box& box) {
    const auto [place, added] = places_.try_emplace(instance.instanceCustomIndex, records_.count());
    if (added) {
        records_.write(place->second, instance);
        setBox(place->second, box);
        restructured_ = true;
        return;
    }
    setBox(place->second, box);
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
            setBox(place->second, boxes_[last]);
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

void TopLevel::takeBoxes() {
    if (!updatable_) {
        return;
    }
    if (touched_.size() > boxes_.size()) {
        built_ = boxes_;
    } else {
        built_.resize(boxes_.size());
        for (const std::uint32_t place : touched_) {
            if (place < boxes_.size()) {
                built_[place] = boxes_[place];
            }
        }
    }
    touched_.clear();
}

void TopLevel::apply(BuildAction action) {
    if (action == BuildAction::Build) {
        takeBoxes();
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
    touched_.assign(boxes_.size() + 1, 0);  // all
}

}  // namespace glint
