#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace collarmesh::improvement {

/// Previous values of an array's entries that changed while the log is on, so that they can be restored.
template <class Value, class Values = std::vector<Value>>
class UndoLog {
 public:
  void begin(std::size_t size) {
    on_ = true;
    size_ = size;
    entries_.clear();
  }
  void end() { on_ = false; }
  /// Records an entry's value. Call this before the entry changes.
  void note(const Values& values, std::size_t i) {
    if (on_ && i < size_) entries_.emplace_back(i, values[i]);
  }
  /// Restores all entries that were present at the beginning, removes those added since, and ends the log.
  void undo(Values& values) {
    for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry)
      values[entry->first] = entry->second;
    values.resize(size_);
    on_ = false;
  }

 private:
  bool on_ = false;
  std::size_t size_ = 0;
  std::vector<std::pair<std::size_t, Value>> entries_;
};

/// An undo log for a stack: restores pushed and popped entries.
template <class Value>
class UndoStack {
 public:
  void begin() {
    on_ = true;
    steps_.clear();
  }
  void end() { on_ = false; }
  void push(std::vector<Value>& stack, const Value& value) {
    stack.push_back(value);
    if (on_) steps_.push_back({true, value});
  }
  Value pop(std::vector<Value>& stack) {
    const Value value = stack.back();
    stack.pop_back();
    if (on_) steps_.push_back({false, value});
    return value;
  }
  void undo(std::vector<Value>& stack) {
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
      if (step->pushed)
        stack.pop_back();
      else
        stack.push_back(step->value);
    }
    on_ = false;
  }

 private:
  struct Step {
    bool pushed;
    Value value;
  };
  bool on_ = false;
  std::vector<Step> steps_;
};

}  // namespace collarmesh::improvement
