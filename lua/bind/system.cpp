// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/file.hpp>
#include <aib/io/fingerprint.hpp>

#include "kit.hpp"
#include <algorithm>
#include <filesystem>
#include <string>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>
#include <vector>

// What the Lua modules of the shell need from the machine: files, the terminal, errors with a kind.

namespace aib::bind {

namespace {

namespace fs = std::filesystem;

/// Names in a folder, sorted by their bytes.
std::vector<std::string> names_in(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    names.push_back(entry->path().filename().string());
  if (error) throw io_error(folder, message("cannot list: ", error.message()));
  std::sort(names.begin(), names.end());
  return names;
}

/// Columns of the terminal behind a descriptor; 80 where there is none.
int terminal_columns(int descriptor) {
  winsize size = {};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

int descriptor_of(const std::string& stream) {
  if (stream == "stdout") return STDOUT_FILENO;
  if (stream == "stderr") return STDERR_FILENO;
  throw argument_error("aib.system: 'stdout' or 'stderr' expected, found '" + stream + "'");
}

error_kind kind_named(const std::string& name) {
  using enum error_kind;
  for (const error_kind kind : {argument, format, io, output, undefined, stopped, internal}) {
    if (name == name_of(kind)) return kind;
  }
  throw argument_error("aib.system.remember: no kind of error is called '" + name + "'");
}

void bind_files(module& system) {
  system
      .function("is_file", {"path"},
                [](const fs::path& path) {
                  std::error_code ignored;
                  return fs::is_regular_file(path, ignored);
                })
      .function("is_folder", {"path"},
                [](const fs::path& path) {
                  std::error_code ignored;
                  return fs::is_directory(path, ignored);
                })
      .function("names_in", {"folder"}, [](const fs::path& folder) { return names_in(folder); })
      .function("read_text", {"path"}, [](const fs::path& path) { return io::read_file(path); })
      .function("write_text", {"path", "text"},
                [](const fs::path& path, const std::string& text) { io::write_file(path, text); })
      .function("fingerprint", {"path"},
                [](lua_State* state, const fs::path& path) {
                  const io::fingerprint f = io::fingerprint_of(path);
                  return record(state).set("bytes", f.bytes).set("sha256", f.sha256);
                })
      .function("make_folder", {"path"},
                [](const fs::path& path) {
                  std::error_code error;
                  fs::create_directories(path, error);
                  if (error) throw output_error(path, message("cannot make it: ", error.message()));
                })
      // Tells a file that was not touched without reading it: size and time of the last change.
      .function("status", {"path"},
                [](const fs::path& path) {
                  std::error_code error;
                  const auto bytes = fs::file_size(path, error);
                  const auto time = fs::last_write_time(path, error);
                  if (error) throw io_error(path, message("cannot look: ", error.message()));
                  return message(bytes, " ", time.time_since_epoch().count());
                })
      .function("sha256", {"text"},
                [](const std::string& text) { return io::sha256().add(text).digest(); });
}

void bind_terminal(module& system) {
  system
      .function("is_terminal", {"stream"},
                [](const std::string& stream) { return isatty(descriptor_of(stream)) == 1; })
      .function("columns", {"stream"},
                [](const std::string& stream) { return terminal_columns(descriptor_of(stream)); });
}

}  // namespace

void bind_system(lua_State* state) {
  module system(state, "system");
  bind_files(system);
  bind_terminal(system);
  system.function("use_threads", {"n"}, [](session& s, unsigned n) { s.threads = n; })
      .function("silence", {}, [](session& s) { s.control.progress = nullptr; })
      .function("suggestion", {"name", "known"},
                [](const std::string& name, const std::vector<std::string>& known) {
                  return suggestion(name, known);
                })
      // Of which kind a message is that a Lua module is about to raise.
      .function("remember", {"kind", "text"},
                [](session& s, const std::string& kind, const std::string& text) {
                  s.remember(kind_named(kind), text);
                });
}

}  // namespace aib::bind
