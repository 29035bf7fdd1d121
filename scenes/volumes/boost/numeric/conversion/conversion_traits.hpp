// See ../../any.hpp. The type that holds the values of both: of a vector or matrix and a number, the first.
#pragma once
#include <type_traits>
namespace boost::numeric {
template <class A, class B, bool are_numbers = std::is_arithmetic_v<A>&& std::is_arithmetic_v<B>>
struct conversion_traits {
  using supertype = std::conditional_t<std::is_arithmetic_v<A>, B, A>;
};
template <class A, class B>
struct conversion_traits<A, B, true> {
  using supertype = std::common_type_t<A, B>;
};
}  // namespace boost::numeric
