#include "process/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "collarmesh/error.h"

namespace collarmesh::process {

Console::Console() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // A closed stream's number is the lowest free one, so the device gets it. It is opened in the wrong
    // direction so that the stream stays unusable.
    const int opened = open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (opened != stream && opened >= 0) close(opened);
  }
}

void Console::tell_text(const std::string& text) const noexcept {
  if (silent_) return;
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void Console::print_result(const std::string& text) const {
  if (silent_) return;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw WriteError(fmt::format("standard output: cannot be written ({})",
                                 errno == 0 ? "no reason given" : std::strerror(errno)));
}

}  // namespace collarmesh::process
