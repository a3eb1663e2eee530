// Lists and sums of what elements of lists have.
#pragma once

#include <functional>
#include <iterator>
#include <vector>

namespace glint::base {

// Returns the values that `make`, a function or a member, has for each element of `list`, in its order.
template <typename Value, typename List, typename Make>
std::vector<Value> mapped(List&& list, const Make& make) {
    std::vector<Value> values;
    values.reserve(std::size(list));
    for (auto&& element : list) {
        values.emplace_back(std::invoke(make, element));
    }
    return values;
}

// Returns the sum of these values, added in that order.
template <typename Value, typename List, typename Make>
Value sumOf(List&& list, const Make& make) {
    Value sum{};
    for (auto&& element : list) {
        sum += std::invoke(make, element);
    }
    return sum;
}

}  // namespace glint::base
