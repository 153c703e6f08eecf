#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

/// What parts of a run carry from one tick to the next, saved and restored by name.
namespace tactus::control {

/// What stands behind one name.
using StateValue = std::variant<std::vector<double>, std::vector<std::int64_t>, std::string>;
/// By path: "controller/task/hold/excess".
using State = std::map<std::string, StateValue, std::less<>>;

/// A state that does not fit what it is restored into; the message names the path.
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Goes through the state of a part by one function for both ways: names its members, which are copied into a State or
/// out of it, to the bit.
///
///   void Hold::doArchive(Archive& archive) {
///     archive("reference", reference_);
///     archive("random", random_);                                // a class with `archive(Archive&)` of its own
///     archive.whole("next", next_, 0, count - 1);                // an index: a state may come from anywhere
///     archive.growing("points", points_);                        // a vector whose length is part of the state
///   }
///
/// Numbers, flags, enumerations, texts, Eigen's vectors, matrices, quaternions and isometries, optionals, and vectors
/// and arrays of all these.  What no tick changes, and what every tick makes anew before it is read, is left out.
///
/// Restoring: a vector keeps its length unless it is `growing`, and another one in the state is a StateError.  A name
/// that the state lacks leaves the member as it is and is noted in `missing`: who restores decides whether that will do.
class Archive {
 public:
  /// Writes what is archived into the state, which outlives it.
  static Archive saving(State& into) { return Archive(&into, nullptr); }
  /// Reads what is archived from the state, which outlives it.
  static Archive restoring(const State& from) { return Archive(nullptr, &from); }

  bool restores() const { return from_ != nullptr; }

  template <class T>
  void operator()(std::string_view name, T& value) {
    within(name, [&] { keep(value); });
  }
  /// A whole number that must be from `least` to `most`, an index for one; another one in the state is a StateError.
  template <class Integer>
  void whole(std::string_view name, Integer& value, std::int64_t least, std::int64_t most) {
    within(name, [&] {
      std::vector<std::int64_t> number{static_cast<std::int64_t>(value)};
      if (!keepIntegers(number) || !restores()) return;
      if (number[0] < least || number[0] > most) failRange(number[0], least, most);
      value = static_cast<Integer>(number[0]);
    });
  }
  /// Numbers of Eigen's types that must be finite.
  template <class Matrix>
  void finite(std::string_view name, Matrix& numbers) {
    within(name, [&] {
      Matrix restored = numbers;
      keep(restored);
      if (restores() && !restored.allFinite()) fail("is not finite");
      numbers = restored;
    });
  }
  /// A vector whose length may differ.  Restoring takes memory where its capacity does not suffice.
  template <class Vector>
  void growing(std::string_view name, Vector& values) {
    within(name, [&] { keepGrowing(values); });
  }
  /// What `step` archives stands below the name.
  template <class Step>
  void within(std::string_view name, Step step) {
    const std::size_t length = path_.size();
    if (!path_.empty()) path_ += '/';
    path_ += name;
    step();
    path_.resize(length);
  }

  /// Paths that were asked for and are not in the state, in their order; empty while saving.
  const std::vector<std::string>& missing() const { return missing_; }
  /// Paths of the state below `prefix` that nobody asked for.
  std::vector<std::string> unclaimed(std::string_view prefix = "") const;

 private:
  Archive(State* into, const State* from) : into_(into), from_(from) {}

  template <class T>
  static constexpr bool is_dense = std::is_base_of_v<Eigen::PlainObjectBase<T>, T>;
  template <class T>
  static constexpr bool isFixed() {
    if constexpr (is_dense<T>) return T::SizeAtCompileTime != Eigen::Dynamic;
    return false;
  }
  template <class T>
  static constexpr bool is_optional = requires(T value) { value.has_value(); };
  template <class T>
  static constexpr bool is_whole = std::is_integral_v<T> || std::is_enum_v<T>;

  template <class T>
  void keep(T& value);
  template <class Vector>
  void keepEach(Vector& values);
  template <class Vector>
  void keepGrowing(Vector& values);

  // While saving `numbers` are written; while restoring they are overwritten, by as many.
  // False: the state lacks the name.
  bool keepReals(std::vector<double>& numbers);
  bool keepIntegers(std::vector<std::int64_t>& numbers);
  bool keepText(std::string& text);
  template <class Number>
  void keepSpan(Number* numbers, std::size_t count);
  const StateValue* find();
  /// That the state holds about as much as it says: a size alone must not ask for all memory.
  void checkGrowth(std::int64_t size) const;
  [[noreturn]] void fail(const std::string& reason) const;
  [[noreturn]] void failRange(std::int64_t value, std::int64_t least, std::int64_t most) const;
  void checkCount(std::size_t in_state, std::size_t wanted) const;

  State* into_;
  const State* from_;
  std::string path_;
  std::vector<std::string> missing_;
  std::set<std::string, std::less<>> claimed_;
};

template <class Number>
void Archive::keepSpan(Number* numbers, std::size_t count) {
  if constexpr (std::is_floating_point_v<Number>) {
    std::vector<double> copy(numbers, numbers + count);
    if (keepReals(copy) && restores()) std::copy(copy.begin(), copy.end(), numbers);
  } else {
    std::vector<std::int64_t> copy(count);
    for (std::size_t i = 0; i < count; ++i) copy[i] = static_cast<std::int64_t>(numbers[i]);
    if (keepIntegers(copy) && restores())
      for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<Number>(copy[i]);
  }
}

template <class T>
void Archive::keep(T& value) {
  if constexpr (std::is_floating_point_v<T> || is_whole<T>) {
    keepSpan(&value, 1);
  } else if constexpr (std::is_same_v<T, std::string>) {
    keepText(value);
  } else if constexpr (is_dense<T>) {
    keepSpan(value.data(), static_cast<std::size_t>(value.size()));
  } else if constexpr (std::is_same_v<T, Eigen::Quaterniond>) {
    keepSpan(value.coeffs().data(), 4);                            // x y z w
  } else if constexpr (std::is_same_v<T, Eigen::Isometry3d>) {
    keepSpan(value.matrix().data(), 16);
  } else if constexpr (is_optional<T>) {
    bool there = value.has_value();
    (*this)("there", there);
    if (there && !value) value.emplace();
    if (!there) value.reset();
    if (value) (*this)("value", *value);
  } else if constexpr (requires { value.archive(*this); }) {
    value.archive(*this);
  } else if constexpr (requires { archive(*this, value); }) {
    archive(*this, value);
  } else {
    keepEach(value);
  }
}

template <class Vector>
void Archive::keepEach(Vector& values) {
  using T = std::remove_cvref_t<decltype(*std::begin(values))>;
  const std::size_t count = std::size(values);
  if constexpr (std::is_same_v<Vector, std::vector<bool>>) {
    std::vector<std::int64_t> copy(values.begin(), values.end());
    if (keepIntegers(copy) && restores()) values.assign(copy.begin(), copy.end());
  } else if constexpr (std::is_floating_point_v<T> || is_whole<T>) {
    keepSpan(std::data(values), count);
  } else if constexpr (isFixed<T>()) {
    std::vector<double> copy;
    for (const T& each : values) copy.insert(copy.end(), each.data(), each.data() + each.size());
    if (!keepReals(copy) || !restores()) return;
    const double* next = copy.data();
    for (T& each : values) {
      std::copy(next, next + each.size(), each.data());
      next += each.size();
    }
  } else {
    std::vector<std::int64_t> size{static_cast<std::int64_t>(count)};
    within("size", [&] {
      keepIntegers(size);
      checkCount(static_cast<std::size_t>(size[0]), count);
    });
    std::size_t index = 0;
    for (T& each : values) (*this)(std::to_string(index++), each);
  }
}

template <class Vector>
void Archive::keepGrowing(Vector& values) {
  std::vector<std::int64_t> size{static_cast<std::int64_t>(std::size(values))};
  bool known = true;
  within("size", [&] { known = keepIntegers(size); });
  if (!known) return;
  if (restores()) {
    checkGrowth(size[0]);
    values.resize(static_cast<std::size_t>(size[0]));
  }
  within("values", [&] { keepEach(values); });
}

}  // namespace tactus::control
