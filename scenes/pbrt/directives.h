// The directives of blocks.cpp, for the table of all directives in directives.cpp. Each is called after its name has
// been read, which is `directive`, at `source`.
#pragma once
#include "scenes/pbrt/reader.h"

namespace metamer::pbrt {

// The string that must follow; without it an error, and whatever belonged to the directive is skipped.
std::optional<std::string> read_string(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);

void attribute_begin(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void attribute_end(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void transform_begin(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void transform_end(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void object_begin(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void object_end(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void object_instance(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
// options.cpp
void read_option(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);

void reverse_orientation(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void world_begin(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void world_end(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void include(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);
void import(Reader& reader, Tokenizer& tokens, std::string_view directive, Source source);

}  // namespace metamer::pbrt
