// Ctrl-C and its like: the first stops the work in good order, the second at once.
#pragma once
#include "engine/schedule/workers.h"

namespace metamer {

// From here on SIGINT, SIGTERM and SIGHUP (unless it was ignored, as under nohup)
//   before there is anything to save: end the program with exit code 1,
//   then, the first time: request `cancellation`,
//   the second time: remove unfinished files and end the program with 128 + the signal's number (130 for SIGINT).
// `cancellation` must live until the program ends. SIGPIPE is ignored: a picture is worth more than its progress.
void install_signal_handlers(Cancellation& cancellation);

// There is a picture to save from now on.
void save_when_interrupted();

}  // namespace metamer
