// An array that never changes, which several owners share instead of copying it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace glint::base {

template <typename Element>
class SharedArray {
public:
    SharedArray() = default;
    SharedArray(std::vector<Element> elements) {
        auto kept = std::make_shared<const std::vector<Element>>(std::move(elements));
        view_ = *kept;
        owner_ = std::move(kept);
    }
    // `view` lives as long as `owner`.
    SharedArray(std::shared_ptr<const void> owner, std::span<const Element> view)
        : owner_(std::move(owner)), view_(view) {}

    const Element* data() const {
        return view_.data();
    }
    std::size_t size() const {
        return view_.size();
    }
    bool empty() const {
        return view_.empty();
    }
    auto begin() const {
        return view_.begin();
    }
    auto end() const {
        return view_.end();
    }
    const Element& operator[](std::size_t index) const {
        return view_[index];
    }
    const std::shared_ptr<const void>& owner() const {
        return owner_;
    }
    friend bool operator==(const SharedArray& a, const SharedArray& b) {
        return (a.data() == b.data() && a.size() == b.size()) || std::ranges::equal(a, b);
    }

private:
    std::shared_ptr<const void> owner_;
    std::span<const Element> view_;
};

}  // namespace glint::base
