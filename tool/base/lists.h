// Makes lists of lists.
#pragma once

#include <functional>
#include <vector>

namespace glint::base {

// Returns the values that `make`, a function or a member, has for each element of `list`, in its order.
template <typename Value, typename List, typename Make>
std::vector<Value> mapped(List&& list, const Make& make) {
    std::vector<Value> values;
    for (auto&& element : list) {
        values.emplace_back(std::invoke(make, element));
    }
    return values;
}

}  // namespace glint::base
