// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include "session.hpp"
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>

namespace aib::bind {

/// "file:line: " of the innermost script function that is running; modules inside the binary are
/// passed over, so that a mistake is reported where it was made. Empty where there is none.
std::string caller(lua_State* state);

/// Pushes the message as a Lua error of the kind, preceded by `caller`.
void push_error(lua_State* state, error_kind kind, const char* what);

/// The one trampoline of the house. Runs `body`, which returns how many results it pushed; a C++
/// exception becomes a Lua error, a string that begins with the caller's file:line. Nothing C++ is
/// alive when the error is raised, and Lua's own errors pass.
template <class Body>
int guard(lua_State* state, Body&& body) {
  try {
    return body();
  } catch (const output_error& e) {
    push_error(state, error_kind::output, e.what());
  } catch (const io_error& e) {
    push_error(state, error_kind::io, e.what());
  } catch (const format_error& e) {
    push_error(state, error_kind::format, e.what());
  } catch (const argument_error& e) {
    push_error(state, error_kind::argument, e.what());
  } catch (const undefined_error& e) {
    push_error(state, error_kind::undefined, e.what());
  } catch (const stopped_error& e) {
    push_error(state, error_kind::stopped, e.what());
  } catch (const std::filesystem::filesystem_error& e) {
    push_error(state, error_kind::io,
               message(e.path1().string(), ": ", e.code().message()).c_str());
  } catch (const std::bad_alloc&) {
    push_error(state, error_kind::internal, "not enough memory");
  } catch (const std::length_error&) {  // more elements than there are addresses
    push_error(state, error_kind::internal, "not enough memory");
  } catch (const std::exception& e) {
    push_error(state, error_kind::internal, e.what());
  }
  return lua_error(state);
}

}  // namespace aib::bind
