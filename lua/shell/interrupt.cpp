// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "interrupt.hpp"

#include "../bind/kit/guard.hpp"
#include <csignal>
#include <pthread.h>
#include <unistd.h>

namespace aib::shell {

namespace {

constexpr int exit_interrupted = 130;

lua_State* running = nullptr;  // written while SIGINT has its default action
pthread_t main_thread;
volatile std::sig_atomic_t caught = 0;

void stop_lua(lua_State* state, lua_Debug*) {
  bind::guard(state, []() -> int { throw stopped_error("interrupted"); });
}

void give_up(int) { _exit(exit_interrupted); }

/// Only what is safe in a signal handler: request_stop is one atomic exchange where nobody waits
/// for the token, and lua_sethook is made for this, on the thread that runs Lua.
void interrupt(int signal) {
  if (!pthread_equal(pthread_self(), main_thread)) {
    pthread_kill(main_thread, signal);
    return;
  }
  if (caught) _exit(exit_interrupted);
  caught = 1;
  bind::session::of(running).stop.request_stop();
  lua_sethook(running, stop_lua, LUA_MASKCOUNT, 1);
  alarm(1);
}

}  // namespace

interruptible::interruptible(lua_State* state) {
  running = state;
  main_thread = pthread_self();
  caught = 0;
  std::signal(SIGALRM, give_up);
  std::signal(SIGINT, interrupt);
}

interruptible::~interruptible() {
  std::signal(SIGINT, SIG_DFL);
  alarm(0);
  std::signal(SIGALRM, SIG_DFL);
  if (!caught) return;
  lua_sethook(running, nullptr, 0, 0);
  bind::session::of(running).restart();
}

bool interruptible::interrupted() const { return caught != 0; }

}  // namespace aib::shell
