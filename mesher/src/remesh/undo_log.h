#pragma once

#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

namespace collarmesh::remeshing {

/// A record of the former values of array entries that change during a trial, so that they can be restored.
/// The array may grow and shrink at its end.
template <class Values>
class UndoLog {
 public:
  using Value = typename Values::value_type;

  /// Keeps a reference to the array.
  explicit UndoLog(Values& values) : values_(values) {}
  UndoLog(const UndoLog&) = delete;
  UndoLog& operator=(const UndoLog&) = delete;

  void begin() {
    assert(!on_);
    on_ = true;
    size_ = values_.size();
    entries_.clear();
  }
  void keep() { on_ = false; }
  /// Records an entry's value. Call this before the entry changes or is removed.
  void note(std::size_t i) {
    if (on_ && i < size_) entries_.emplace_back(i, values_[i]);
  }
  void set(std::size_t i, const Value& value) {
    assert(i < values_.size());
    note(i);
    values_[i] = value;
  }
  /// Removes the last entry and returns it.
  Value pop() {
    assert(!values_.empty());
    const Value last = values_.back();
    note(values_.size() - 1);
    values_.pop_back();
    return last;
  }
  std::size_t size_before() const { return size_; }
  /// Returns the entries noted since the beginning of the trial, with their former values.
  const std::vector<std::pair<std::size_t, Value>>& noted() const { return entries_; }
  /// Restores all entries that were present at the beginning, removes those added since, and ends the trial.
  void undo() {
    assert(on_);
    values_.resize(size_);
    for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry)
      values_[entry->first] = entry->second;
    on_ = false;
  }

 private:
  Values& values_;
  bool on_ = false;
  std::size_t size_ = 0;
  std::vector<std::pair<std::size_t, Value>> entries_;
};

}  // namespace collarmesh::remeshing
