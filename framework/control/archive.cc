#include "framework/control/archive.h"

namespace tactus::control {

std::vector<std::string> Archive::unclaimed(std::string_view prefix) const {
  std::vector<std::string> paths;
  if (!from_) return paths;
  for (auto entry = from_->lower_bound(prefix); entry != from_->end() && entry->first.starts_with(prefix); ++entry)
    if (!claimed_.contains(entry->first)) paths.push_back(entry->first);
  return paths;
}

void Archive::fail(const std::string& reason) const { throw StateError("state '" + path_ + "' " + reason); }

void Archive::failRange(std::int64_t value, std::int64_t least, std::int64_t most) const {
  fail("is " + std::to_string(value) + ", and must be from " + std::to_string(least) + " to " + std::to_string(most));
}

void Archive::checkGrowth(std::int64_t size) const {
  std::size_t held = from_->size();                                // of classes: an entry each at least
  const auto values = from_->find(path_ + "/values");
  if (values != from_->end())
    held = std::visit([](const auto& stored) { return stored.size(); }, values->second);
  if (size < 0 || static_cast<std::uint64_t>(size) > held)
    fail("has a size of " + std::to_string(size) + ", and holds no more than " + std::to_string(held));
}

void Archive::checkCount(std::size_t in_state, std::size_t wanted) const {
  if (in_state == wanted) return;
  const auto numbers = [](std::size_t n) { return std::to_string(n) + (n == 1 ? " number" : " numbers"); };
  fail("has " + numbers(in_state) + ", and this stack needs " + std::to_string(wanted));
}

const StateValue* Archive::find() {
  const auto entry = from_->find(path_);
  if (entry == from_->end()) {
    missing_.push_back(path_);
    return nullptr;
  }
  claimed_.insert(path_);
  return &entry->second;
}

bool Archive::keepReals(std::vector<double>& numbers) {
  if (into_) {
    (*into_)[path_] = numbers;
    return true;
  }
  const StateValue* value = find();
  if (!value) return false;
  if (const auto* reals = std::get_if<std::vector<double>>(value)) {
    checkCount(reals->size(), numbers.size());
    numbers = *reals;
    return true;
  }
  const auto* integers = std::get_if<std::vector<std::int64_t>>(value);
  if (!integers) fail("is a text, and this stack needs numbers");
  checkCount(integers->size(), numbers.size());
  numbers.assign(integers->begin(), integers->end());
  return true;
}

bool Archive::keepIntegers(std::vector<std::int64_t>& numbers) {
  if (into_) {
    (*into_)[path_] = numbers;
    return true;
  }
  const StateValue* value = find();
  if (!value) return false;
  const auto* integers = std::get_if<std::vector<std::int64_t>>(value);
  if (!integers) fail("needs whole numbers");
  checkCount(integers->size(), numbers.size());
  numbers = *integers;
  return true;
}

bool Archive::keepText(std::string& text) {
  if (into_) {
    (*into_)[path_] = text;
    return true;
  }
  const StateValue* value = find();
  if (!value) return false;
  const auto* stored = std::get_if<std::string>(value);
  if (!stored) fail("needs a text");
  text = *stored;
  return true;
}

}  // namespace tactus::control
