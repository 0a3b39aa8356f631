#pragma once
// Included before every file where the C++ library lacks them (libc++ 13 of Debian's Emscripten): the range algorithms
// and std::bit_cast, as far as the engine uses them, over the algorithms of C++17.

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <iterator>
#include <type_traits>
#include <utility>

namespace std {

template <class To, class From>
To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof(to));
    return to;
}

namespace ranges {
namespace older {

struct Same {
    template <class Type>
    constexpr Type&& operator()(Type&& value) const noexcept {
        return std::forward<Type>(value);
    }
};

template <class Action, class Projection>
constexpr auto on(Action& action, Projection& projection) {
    return [&](auto&& one) -> decltype(auto) { return std::invoke(action, std::invoke(projection, one)); };
}

template <class Compare, class Projection>
constexpr auto by(Compare& compare, Projection& projection) {
    return [&](auto&& one, auto&& other) {
        return std::invoke(compare, std::invoke(projection, one), std::invoke(projection, other));
    };
}

template <class In, class Out>
struct InOut {
    In in;
    Out out;
};

template <class Type>
struct MinMax {
    Type min;
    Type max;
};

template <class Range>
concept IsRange = requires(Range&& range) {
    std::begin(range);
};

}  // namespace older

template <older::IsRange Range, class Out>
constexpr auto copy(Range&& range, Out out) {
    return older::InOut<decltype(std::end(range)), Out>{std::end(range),
                                                        std::copy(std::begin(range), std::end(range), out)};
}
template <class In, class Out>
requires(!older::IsRange<In>) constexpr auto copy(In first, In last, Out out) {
    return older::InOut<In, Out>{last, std::copy(first, last, out)};
}
template <class Range, class Out>
constexpr auto copy_backward(Range&& range, Out out) {
    return std::copy_backward(std::begin(range), std::end(range), out);
}
template <class Range, class Out>
constexpr auto reverse_copy(Range&& range, Out out) {
    return std::reverse_copy(std::begin(range), std::end(range), out);
}
template <class Range, class Type>
constexpr void fill(Range&& range, const Type& value) {
    std::fill(std::begin(range), std::end(range), value);
}
template <class Range, class Make>
constexpr void generate(Range&& range, Make make) {
    std::generate(std::begin(range), std::end(range), std::move(make));
}
template <older::IsRange Range, class Out, class Action, class Projection = older::Same>
requires(!older::IsRange<Out>) constexpr auto transform(Range&& range, Out out, Action action,
                                                        Projection projection = {}) {
    return older::InOut<decltype(std::end(range)), Out>{
        std::end(range), std::transform(std::begin(range), std::end(range), out, older::on(action, projection))};
}
template <older::IsRange Range, older::IsRange Other, class Out, class Action>
constexpr auto transform(Range&& range, Other&& other, Out out, Action action) {
    return std::transform(std::begin(range), std::end(range), std::begin(other), out, std::move(action));
}
template <class Range, class Type, class Projection = older::Same>
constexpr auto find(Range&& range, const Type& value, Projection projection = {}) {
    return std::find_if(std::begin(range), std::end(range),
                        [&](auto&& one) { return std::invoke(projection, one) == value; });
}
template <class Range, class Test, class Projection = older::Same>
constexpr auto find_if(Range&& range, Test test, Projection projection = {}) {
    return std::find_if(std::begin(range), std::end(range), older::on(test, projection));
}
template <class Range, class Type>
constexpr auto count(Range&& range, const Type& value) {
    return std::count(std::begin(range), std::end(range), value);
}
template <class Range, class Test, class Projection = older::Same>
constexpr bool all_of(Range&& range, Test test, Projection projection = {}) {
    return std::all_of(std::begin(range), std::end(range), older::on(test, projection));
}
template <class Range, class Test, class Projection = older::Same>
constexpr bool any_of(Range&& range, Test test, Projection projection = {}) {
    return std::any_of(std::begin(range), std::end(range), older::on(test, projection));
}
template <class Range, class Test, class Projection = older::Same>
constexpr bool none_of(Range&& range, Test test, Projection projection = {}) {
    return std::none_of(std::begin(range), std::end(range), older::on(test, projection));
}
template <class Range, class Action, class Projection = older::Same>
constexpr void for_each(Range&& range, Action action, Projection projection = {}) {
    for (auto&& one : range) {
        (void)std::invoke(action, std::invoke(projection, one));
    }
}
template <class Range, class Compare = std::less<>, class Projection = older::Same>
constexpr void sort(Range&& range, Compare compare = {}, Projection projection = {}) {
    std::sort(std::begin(range), std::end(range), older::by(compare, projection));
}
template <class Range, class Compare = std::less<>, class Projection = older::Same>
void stable_sort(Range&& range, Compare compare = {}, Projection projection = {}) {
    std::stable_sort(std::begin(range), std::end(range), older::by(compare, projection));
}
template <class Range, class Iterator, class Compare = std::less<>, class Projection = older::Same>
constexpr void nth_element(Range&& range, Iterator nth, Compare compare = {}, Projection projection = {}) {
    std::nth_element(std::begin(range), nth, std::end(range), older::by(compare, projection));
}
template <older::IsRange Range, class Compare = std::less<>, class Projection = older::Same>
constexpr auto max_element(Range&& range, Compare compare = {}, Projection projection = {}) {
    return std::max_element(std::begin(range), std::end(range), older::by(compare, projection));
}
template <older::IsRange Range, class Compare = std::less<>, class Projection = older::Same>
constexpr auto min_element(Range&& range, Compare compare = {}, Projection projection = {}) {
    return std::min_element(std::begin(range), std::end(range), older::by(compare, projection));
}
template <class Range, class Compare = std::less<>>
constexpr auto minmax(Range&& range, Compare compare = {}) {
    const auto found = std::minmax_element(std::begin(range), std::end(range), compare);
    return older::MinMax<std::decay_t<decltype(*found.first)>>{*found.first, *found.second};
}
template <older::IsRange Range>
constexpr auto max(Range&& range) {
    return *std::max_element(std::begin(range), std::end(range));
}
template <older::IsRange Range>
constexpr auto min(Range&& range) {
    return *std::min_element(std::begin(range), std::end(range));
}
template <class Range, class Type, class Compare = std::less<>, class Projection = older::Same>
constexpr auto upper_bound(Range&& range, const Type& value, Compare compare = {}, Projection projection = {}) {
    return std::upper_bound(std::begin(range), std::end(range), value, [&](const auto& one, auto&& other) {
        return std::invoke(compare, one, std::invoke(projection, other));
    });
}
template <class Range, class Type, class Compare = std::less<>, class Projection = older::Same>
constexpr auto lower_bound(Range&& range, const Type& value, Compare compare = {}, Projection projection = {}) {
    return std::lower_bound(std::begin(range), std::end(range), value, [&](const auto& one, const auto& other) {
        return std::invoke(compare, std::invoke(projection, one), other);
    });
}
template <class Range>
constexpr auto unique(Range&& range) {
    struct Rest {
        decltype(std::begin(range)) first;
        decltype(std::end(range)) last;
        [[nodiscard]] constexpr auto begin() const { return first; }
        [[nodiscard]] constexpr auto end() const { return last; }
    };
    return Rest{std::unique(std::begin(range), std::end(range)), std::end(range)};
}
template <class Range, class Iterator>
constexpr auto rotate(Range&& range, Iterator middle) {
    return std::rotate(std::begin(range), middle, std::end(range));
}
template <class Range, class Other>
constexpr bool is_permutation(Range&& range, Other&& other) {
    return std::is_permutation(std::begin(range), std::end(range), std::begin(other), std::end(other));
}
template <class Range, class Other>
constexpr bool equal(Range&& range, Other&& other) {
    return std::equal(std::begin(range), std::end(range), std::begin(other), std::end(other));
}
template <class Range, class Test = std::equal_to<>>
constexpr auto adjacent_find(Range&& range, Test test = {}) {
    return std::adjacent_find(std::begin(range), std::end(range), std::move(test));
}

}  // namespace ranges
}  // namespace std
