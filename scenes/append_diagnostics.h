// Messages of several threads in an order of their own: each thread collects its own, appended in the end.
#pragma once
#include "engine/diagnostics.h"

namespace metamer {

inline void append_diagnostics(Diagnostics& all, const Diagnostics& some) {
  for (const Diagnostic& d : some.all()) {
    const SourceLocation at{d.file, d.line};
    switch (d.severity) {
      case Severity::note: all.note(at, d.message, d.strict); break;
      case Severity::warning: all.warning(at, d.message, d.strict); break;
      case Severity::error: all.error(at, d.message); break;
    }
  }
}

}  // namespace metamer
