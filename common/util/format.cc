#include "common/util/format.h"

#include <cstdarg>
#include <cstdio>
#include <stdexcept>

namespace airdos {

std::string Format(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  // The terminating zero lands where the string keeps its own.
  const int written = std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  if (length < 0 || written != length) throw std::runtime_error("a text that printf cannot make");
  return text;
}

}  // namespace airdos
