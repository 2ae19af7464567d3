// Access to each field of a plain struct, for tests that compare or fill whole structs and must not forget a field.
#pragma once

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace trammel::testing {

struct AnyField {
  template <class T>
  operator T() const;
};

template <class T, class Indices, class = void>
struct TakesFields : std::false_type {};
template <class T, std::size_t... I>
struct TakesFields<T, std::index_sequence<I...>, std::void_t<decltype(T{(static_cast<void>(I), AnyField())...})>>
    : std::true_type {};

template <class T, std::size_t N>
constexpr std::size_t count_fields() {
  if constexpr (N == 0 || TakesFields<T, std::make_index_sequence<N>>::value)
    return N;
  else
    return count_fields<T, N - 1>();
}
constexpr std::size_t kMaxFields = 60;
template <class T>
constexpr std::size_t kFields = count_fields<std::remove_const_t<T>, kMaxFields + 1>();

// References to all fields, as a tuple. C++17 can name the fields of a struct only one by one, so there is one case for
// each number of fields.
// clang-format off
#define TRAMMEL_FIELDS_1 f1
#define TRAMMEL_FIELDS_2 TRAMMEL_FIELDS_1, f2
#define TRAMMEL_FIELDS_3 TRAMMEL_FIELDS_2, f3
#define TRAMMEL_FIELDS_4 TRAMMEL_FIELDS_3, f4
#define TRAMMEL_FIELDS_5 TRAMMEL_FIELDS_4, f5
#define TRAMMEL_FIELDS_6 TRAMMEL_FIELDS_5, f6
#define TRAMMEL_FIELDS_7 TRAMMEL_FIELDS_6, f7
#define TRAMMEL_FIELDS_8 TRAMMEL_FIELDS_7, f8
#define TRAMMEL_FIELDS_9 TRAMMEL_FIELDS_8, f9
#define TRAMMEL_FIELDS_10 TRAMMEL_FIELDS_9, f10
#define TRAMMEL_FIELDS_11 TRAMMEL_FIELDS_10, f11
#define TRAMMEL_FIELDS_12 TRAMMEL_FIELDS_11, f12
#define TRAMMEL_FIELDS_13 TRAMMEL_FIELDS_12, f13
#define TRAMMEL_FIELDS_14 TRAMMEL_FIELDS_13, f14
#define TRAMMEL_FIELDS_15 TRAMMEL_FIELDS_14, f15
#define TRAMMEL_FIELDS_16 TRAMMEL_FIELDS_15, f16
#define TRAMMEL_FIELDS_17 TRAMMEL_FIELDS_16, f17
#define TRAMMEL_FIELDS_18 TRAMMEL_FIELDS_17, f18
#define TRAMMEL_FIELDS_19 TRAMMEL_FIELDS_18, f19
#define TRAMMEL_FIELDS_20 TRAMMEL_FIELDS_19, f20
#define TRAMMEL_FIELDS_21 TRAMMEL_FIELDS_20, f21
#define TRAMMEL_FIELDS_22 TRAMMEL_FIELDS_21, f22
#define TRAMMEL_FIELDS_23 TRAMMEL_FIELDS_22, f23
#define TRAMMEL_FIELDS_24 TRAMMEL_FIELDS_23, f24
#define TRAMMEL_FIELDS_25 TRAMMEL_FIELDS_24, f25
#define TRAMMEL_FIELDS_26 TRAMMEL_FIELDS_25, f26
#define TRAMMEL_FIELDS_27 TRAMMEL_FIELDS_26, f27
#define TRAMMEL_FIELDS_28 TRAMMEL_FIELDS_27, f28
#define TRAMMEL_FIELDS_29 TRAMMEL_FIELDS_28, f29
#define TRAMMEL_FIELDS_30 TRAMMEL_FIELDS_29, f30
#define TRAMMEL_FIELDS_31 TRAMMEL_FIELDS_30, f31
#define TRAMMEL_FIELDS_32 TRAMMEL_FIELDS_31, f32
#define TRAMMEL_FIELDS_33 TRAMMEL_FIELDS_32, f33
#define TRAMMEL_FIELDS_34 TRAMMEL_FIELDS_33, f34
#define TRAMMEL_FIELDS_35 TRAMMEL_FIELDS_34, f35
#define TRAMMEL_FIELDS_36 TRAMMEL_FIELDS_35, f36
#define TRAMMEL_FIELDS_37 TRAMMEL_FIELDS_36, f37
#define TRAMMEL_FIELDS_38 TRAMMEL_FIELDS_37, f38
#define TRAMMEL_FIELDS_39 TRAMMEL_FIELDS_38, f39
#define TRAMMEL_FIELDS_40 TRAMMEL_FIELDS_39, f40
#define TRAMMEL_FIELDS_41 TRAMMEL_FIELDS_40, f41
#define TRAMMEL_FIELDS_42 TRAMMEL_FIELDS_41, f42
#define TRAMMEL_FIELDS_43 TRAMMEL_FIELDS_42, f43
#define TRAMMEL_FIELDS_44 TRAMMEL_FIELDS_43, f44
#define TRAMMEL_FIELDS_45 TRAMMEL_FIELDS_44, f45
#define TRAMMEL_FIELDS_46 TRAMMEL_FIELDS_45, f46
#define TRAMMEL_FIELDS_47 TRAMMEL_FIELDS_46, f47
#define TRAMMEL_FIELDS_48 TRAMMEL_FIELDS_47, f48
#define TRAMMEL_FIELDS_49 TRAMMEL_FIELDS_48, f49
#define TRAMMEL_FIELDS_50 TRAMMEL_FIELDS_49, f50
#define TRAMMEL_FIELDS_51 TRAMMEL_FIELDS_50, f51
#define TRAMMEL_FIELDS_52 TRAMMEL_FIELDS_51, f52
#define TRAMMEL_FIELDS_53 TRAMMEL_FIELDS_52, f53
#define TRAMMEL_FIELDS_54 TRAMMEL_FIELDS_53, f54
#define TRAMMEL_FIELDS_55 TRAMMEL_FIELDS_54, f55
#define TRAMMEL_FIELDS_56 TRAMMEL_FIELDS_55, f56
#define TRAMMEL_FIELDS_57 TRAMMEL_FIELDS_56, f57
#define TRAMMEL_FIELDS_58 TRAMMEL_FIELDS_57, f58
#define TRAMMEL_FIELDS_59 TRAMMEL_FIELDS_58, f59
#define TRAMMEL_FIELDS_60 TRAMMEL_FIELDS_59, f60
#define TRAMMEL_TIE(n) \
  else if constexpr (kFields<T> == n) { auto& [TRAMMEL_FIELDS_##n] = value; return std::tie(TRAMMEL_FIELDS_##n); }

template <class T>
auto fields_of(T& value) {
  static_assert(kFields<T> <= kMaxFields, "more fields than this header foresees");
  if constexpr (kFields<T> == 0) return std::tuple<>();
  TRAMMEL_TIE(1) TRAMMEL_TIE(2) TRAMMEL_TIE(3) TRAMMEL_TIE(4) TRAMMEL_TIE(5)
  TRAMMEL_TIE(6) TRAMMEL_TIE(7) TRAMMEL_TIE(8) TRAMMEL_TIE(9) TRAMMEL_TIE(10)
  TRAMMEL_TIE(11) TRAMMEL_TIE(12) TRAMMEL_TIE(13) TRAMMEL_TIE(14) TRAMMEL_TIE(15)
  TRAMMEL_TIE(16) TRAMMEL_TIE(17) TRAMMEL_TIE(18) TRAMMEL_TIE(19) TRAMMEL_TIE(20)
  TRAMMEL_TIE(21) TRAMMEL_TIE(22) TRAMMEL_TIE(23) TRAMMEL_TIE(24) TRAMMEL_TIE(25)
  TRAMMEL_TIE(26) TRAMMEL_TIE(27) TRAMMEL_TIE(28) TRAMMEL_TIE(29) TRAMMEL_TIE(30)
  TRAMMEL_TIE(31) TRAMMEL_TIE(32) TRAMMEL_TIE(33) TRAMMEL_TIE(34) TRAMMEL_TIE(35)
  TRAMMEL_TIE(36) TRAMMEL_TIE(37) TRAMMEL_TIE(38) TRAMMEL_TIE(39) TRAMMEL_TIE(40)
  TRAMMEL_TIE(41) TRAMMEL_TIE(42) TRAMMEL_TIE(43) TRAMMEL_TIE(44) TRAMMEL_TIE(45)
  TRAMMEL_TIE(46) TRAMMEL_TIE(47) TRAMMEL_TIE(48) TRAMMEL_TIE(49) TRAMMEL_TIE(50)
  TRAMMEL_TIE(51) TRAMMEL_TIE(52) TRAMMEL_TIE(53) TRAMMEL_TIE(54) TRAMMEL_TIE(55)
  TRAMMEL_TIE(56) TRAMMEL_TIE(57) TRAMMEL_TIE(58) TRAMMEL_TIE(59) TRAMMEL_TIE(60)
}
#undef TRAMMEL_TIE
// clang-format on

template <class T, class = void>
struct HasState : std::false_type {};
template <class T>
struct HasState<T, std::void_t<decltype(std::declval<const T&>().state())>> : std::true_type {};
template <class T, class = void>
struct HasOutputs : std::false_type {};
template <class T>
struct HasOutputs<T, std::void_t<decltype(std::declval<const T&>().outputs())>> : std::true_type {};
template <class T>
struct IsList : std::false_type {};
template <class T, std::size_t N>
struct IsList<std::array<T, N>> : std::true_type {};
template <class T>
struct IsList<std::vector<T>> : std::true_type {};

template <class T>
bool same(const T& a, const T& b) {
  if constexpr (HasState<T>::value) {
    return same(a.state(), b.state());
  } else if constexpr (IsList<T>::value) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (!same(a[i], b[i])) return false;
    }
    return true;
  } else if constexpr (std::is_aggregate_v<T>) {
    const auto x = fields_of(a);
    const auto y = fields_of(b);
    return std::apply(
        [&](const auto&... left) {
          return std::apply([&](const auto&... right) { return (same(left, right) && ...); }, y);
        },
        x);
  } else {
    return a == b;
  }
}

}  // namespace trammel::testing
