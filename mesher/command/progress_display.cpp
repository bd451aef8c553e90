#include "command/progress_display.h"
#include "report/json_text.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>

namespace collarmesh::command {

namespace {

std::size_t terminal_width() {
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

std::string rounded_count(std::size_t count) {
  if (count >= 1000000) return fmt::format("{:.1f}M", static_cast<double>(count) / 1e6);
  if (count >= 1000) return fmt::format("{}k", count / 1000);
  return fmt::format("{}", count);
}

std::string rounded_time(double seconds) {
  if (seconds >= 3600) return fmt::format("{:.1f} h", seconds / 3600);
  if (seconds >= 120) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.0f} s", seconds);
}

}  // namespace

std::string progress_line(const std::string& phase, double fraction, std::size_t tets, double seconds,
                          std::size_t width) {
  constexpr std::size_t bar_width = 24;
  const auto filled = static_cast<std::size_t>(std::lround(fraction * bar_width));
  std::string line = fmt::format("[{}{}] {:3.0f}%  {}", std::string(filled, '#'),
                                 std::string(bar_width - filled, '.'), 100 * fraction, phase);
  if (tets > 0) line += fmt::format("  {} tets", rounded_count(tets));
  if (seconds > 0.5 && fraction > 0.02)
    line += fmt::format("  {} left", rounded_time(seconds * (1 - fraction) / fraction));
  return line.substr(0, width);
}

ProgressDisplay::ProgressDisplay(const process::Console& console, ProgressStyle style)
    : console_(console),
      form_(style == ProgressStyle::json                                 ? Form::json
            : style == ProgressStyle::automatic && isatty(STDERR_FILENO) ? Form::bar
                                                                         : Form::nothing) {
  if (form_ != Form::bar) return;
  try {
    drawing_ = std::thread([this] { keep_drawing(); });
  } catch (const std::system_error&) {
    form_ = Form::nothing;
  }
}

ProgressDisplay::~ProgressDisplay() {
  if (form_ != Form::bar) return;
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  wake_.notify_one();
  drawing_.join();
}

void ProgressDisplay::begin_stage(std::string phase, double begin, double end) {
  const std::lock_guard lock(mutex_);
  phase_ = std::move(phase);
  begin_ = begin;
  end_ = end;
  fraction_ = std::max(fraction_, begin);
  print_json();
}

void ProgressDisplay::print(const std::string& text) {
  if (text.empty()) return;
  const std::lock_guard lock(mutex_);
  console_.tell("{}{}", form_ == Form::bar ? "\r\033[K" : "", text);
}

void ProgressDisplay::update(const ProgressReport& report) {
  const std::lock_guard lock(mutex_);
  const bool new_phase = phase_ != report.phase;
  phase_ = report.phase;
  fraction_ = std::max(fraction_, begin_ + std::clamp(report.fraction, 0.0, 1.0) * (end_ - begin_));
  vertices_ = report.vertices;
  tets_ = report.tets;
  if (new_phase || stopwatch_.seconds() - json_printed_ > 0.25) print_json();
}

void ProgressDisplay::print_json() {
  if (form_ != Form::json) return;
  json_printed_ = stopwatch_.seconds();
  const nlohmann::ordered_json line{{"phase", phase_},
                                    {"fraction", fraction_},
                                    {"vertices", vertices_},
                                    {"tets", tets_},
                                    {"seconds", json_printed_}};
  console_.tell("{}\n", report::json_text(line));
}

void ProgressDisplay::redraw() {
  if (phase_.empty()) return;
  console_.tell("\r{}\033[K",
                progress_line(phase_, fraction_, tets_, stopwatch_.seconds(), terminal_width() - 1));
}

void ProgressDisplay::keep_drawing() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, std::chrono::milliseconds(150), [this] { return finished_; })) redraw();
  console_.tell("\r\033[K");
}

}  // namespace collarmesh::command
