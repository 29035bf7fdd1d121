// What is to be said about how a picture looks.
#pragma once
#include <string>

#include "systems/write_frame.h"

namespace metamer {

// The tone mapping by name: a curve with its parameter, aces, or a view and its display.
std::string tone_map_text(const Look& look);

// To standard error: how many pixels need negative amounts of the lamps, and how negative. Nothing for other displays.
void tell_negative_amounts(const Developed& developed);

}  // namespace metamer
