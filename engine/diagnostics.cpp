#include "engine/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace metamer {
namespace {

constexpr size_t max_printed = 100;
constexpr size_t longest_text = 2000;  // of a message or a file's name, bytes
constexpr size_t longest_word = 64;    // that could be a mistyped one

// Insertions, deletions, substitutions and swaps of neighbours ("optimal string alignment").
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    std::swap(before_last, last);
    std::swap(last, row);
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row.back();
}

// Names in messages come from files: no control characters reach the terminal, nor megabytes.
std::string readable(std::string_view text) {
  std::string out(text.substr(0, longest_text));
  for (char& c : out)
    if ((c >= 0 && c < ' ') || c == 0x7f) c = '?';
  if (text.size() > longest_text) out += "...";
  return out;
}

std::string_view severity_name(Severity severity) {
  switch (severity) {
    case Severity::note: return "note";
    case Severity::warning: return "warning";
    case Severity::error: break;
  }
  return "error";
}

}  // namespace

void Diagnostics::error(const SourceLocation& at, std::string message) {
  entries_.push_back({Severity::error, at.file, at.line, std::move(message)});
  ++error_count_;
}

void Diagnostics::warning(const SourceLocation& at, std::string message, Strict strict) {
  entries_.push_back({Severity::warning, at.file, at.line, std::move(message), strict});
}

void Diagnostics::note(const SourceLocation& at, std::string message, Strict strict) {
  entries_.push_back({Severity::note, at.file, at.line, std::move(message), strict});
}

void Diagnostics::apply_strict() {
  for (Diagnostic& d : entries_) {
    if (d.severity == Severity::error || d.strict == Strict::allows) continue;
    d.severity = Severity::error;
    ++error_count_;
  }
}

std::string format_diagnostics(const Diagnostics& diagnostics) {
  std::vector<const Diagnostic*> order;
  for (const Diagnostic& d : diagnostics.all()) order.push_back(&d);
  std::stable_sort(order.begin(), order.end(), [](const Diagnostic* a, const Diagnostic* b) {
    return a->file != b->file ? a->file < b->file : a->line < b->line;
  });
  std::string text;
  for (size_t i = 0; i < std::min(order.size(), max_printed); ++i) {
    const Diagnostic& d = *order[i];
    const std::string place = d.line > 0 ? fmt::format("{}:{}", readable(d.file), d.line) : readable(d.file);
    text += fmt::format("{}: {}: {}\n", place, severity_name(d.severity), readable(d.message));
  }
  if (order.size() > max_printed) text += fmt::format("... and {} more\n", order.size() - max_printed);
  return text;
}

std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates) {
  std::string_view best;
  if (word.size() > longest_word) return {};
  size_t best_distance = std::max<size_t>(1, word.size() / 3) + 1;
  for (const std::string_view candidate : candidates) {
    const size_t longer = std::max(word.size(), candidate.size()), shorter = std::min(word.size(), candidate.size());
    if (longer - shorter >= best_distance) continue;  // as many insertions at least
    const size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return std::string(best);
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string nearest = nearest_word(word, candidates);
  return nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest);
}

}  // namespace metamer
