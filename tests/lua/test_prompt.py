# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Drives the prompt of aib-lua through a pseudo-terminal: test_prompt.py AIB_LUA [--plain]

--plain says that it was built without libedit: no completion, no history.
"""

import os
import pty
import re
import select
import signal
import sys
import tempfile
import time

PATIENCE_S = 30  # a test that waits longer has failed; nothing is measured


class Prompt:
    """A session at the prompt."""

    def __init__(self, program, state_folder, *arguments):
        environment = {"PATH": os.environ["PATH"], "HOME": state_folder, "TERM": "dumb",
                       "XDG_STATE_HOME": state_folder}
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.execve(program, [program, *arguments], environment)
        self.transcript = ""
        self.seen = 0
        self.closed = False

    def send(self, text):
        os.write(self.terminal, text.encode())

    def expect(self, part):
        """Waits for a text after what was seen before."""
        deadline = time.monotonic() + PATIENCE_S
        while (at := self.transcript.find(part, self.seen)) < 0:
            if not self.read_more(deadline):
                raise AssertionError(f"expected {part!r}, found {self.transcript[self.seen:]!r}")
        self.seen = at + len(part)

    def read_more(self, deadline):
        ready, _, _ = select.select([self.terminal], [], [], max(0, deadline - time.monotonic()))
        if not ready:
            return False
        try:
            piece = os.read(self.terminal, 4096).decode(errors="replace")
        except OSError:  # the other end is closed
            piece = ""
            self.closed = True
        self.transcript += re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]|\r", "", piece)
        return piece != ""

    def line(self, text, *answers):
        """Types a line and waits for the answers and the next prompt."""
        self.send(text + "\n")
        for answer in answers:
            self.expect(answer)
        self.expect("> ")

    def end(self):
        """Types Ctrl-D, again where it came before the editor had the terminal, which swallows it."""
        for _ in range(PATIENCE_S):
            self.send("\x15\x04")  # Ctrl-U clears what an early one left on the line
            deadline = time.monotonic() + 1
            while self.read_more(deadline):
                pass
            if self.closed:
                break
        os.close(self.terminal)
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])


def greets_and_ends(start):
    prompt = start()
    prompt.expect("aib ")
    prompt.expect("> ")
    assert prompt.end() == 0


def echoes_values(start):
    prompt = start()
    prompt.expect("> ")
    prompt.line("1 + 2", "\n3\n")
    prompt.line("_ * 2", "\n6\n")
    prompt.line("'text', nil, true", '\n"text"  nil  true\n')
    prompt.line("{ 3, 4, name = { 5 } }", "\n{3, 4, name = {5}}\n")
    prompt.line("aib.stats.moments():add(3)", "\nmoments(1 values, mean 3, std 0)\n")
    prompt.line("x = 7")
    prompt.line("x", "\n7\n")
    assert prompt.end() == 0


def goes_on_over_lines(start):
    prompt = start()
    prompt.expect("> ")
    prompt.send("function twice(x)\n")
    prompt.expect(">> ")
    prompt.send("return 2 * x\n")
    prompt.expect(">> ")
    prompt.line("end")
    prompt.line("twice(4)", "\n8\n")
    assert prompt.end() == 0


def tells_errors_and_goes_on(start):
    prompt = start()
    prompt.expect("> ")
    prompt.line("aib.stats.quantile({1}, 0.5, {rul = 1})",
                "stdin:1: aib.stats.quantile: unknown option 'rul', did you mean 'rule'?")
    prompt.line("prnt(1)", "undefined variable 'prnt', did you mean 'print'?")
    prompt.line("x = = 3", "unexpected symbol near '='")
    prompt.line("1", "\n1\n")
    assert prompt.end() == 0


def helps(start):
    prompt = start()
    prompt.expect("> ")
    prompt.line("help(aib.stats.quantile)", "aib.stats.quantile(values, q, options)", "rule?", "returns:")
    prompt.line("help()", "Tab completes")
    assert prompt.end() == 0


def stops_on_ctrl_c(start):
    prompt = start()
    prompt.expect("> ")
    prompt.send("print('begun') while true do end\n")
    prompt.expect("\nbegun\n")
    os.kill(prompt.pid, signal.SIGINT)
    prompt.expect("> ")
    prompt.line("1 + 1", "\n2\n")
    assert prompt.end() == 0


def gives_up_a_line_on_ctrl_c(start):
    prompt = start()
    prompt.expect("> ")
    prompt.send("nonsense = (")
    prompt.expect("nonsense = (")
    prompt.send("\x03")
    prompt.expect("> ")
    prompt.line("1 + 1", "\n2\n")
    assert prompt.end() == 0


def completes(start):
    prompt = start()
    prompt.expect("> ")
    prompt.send("aib.stats.quan\t")
    prompt.expect("aib.stats.quantile")
    prompt.send("({ 4 }, 0, { ru\t")
    prompt.expect("rule = ")
    prompt.line("'lower' })", "\n4.0\n")
    prompt.send("aib.stats.moments():ad\t\x15")  # of what a call gives nothing is known
    prompt.line("1", "\n1\n")
    assert prompt.end() == 0


def remembers_lines(start):
    prompt = start()
    prompt.expect("> ")
    prompt.line("41 + 1", "\n42\n")
    assert prompt.end() == 0
    prompt = start()
    prompt.expect("> ")
    prompt.send("\x10")  # Ctrl-P, the line before
    prompt.expect("41 + 1")
    prompt.line("", "\n42\n")
    assert prompt.end() == 0


def converses_after_a_script(start):
    prompt = start("-i", "-e", "x = 5")
    prompt.expect("> ")
    prompt.line("x", "\n5\n")
    assert prompt.end() == 0


ALWAYS = [greets_and_ends, echoes_values, goes_on_over_lines, tells_errors_and_goes_on, helps,
          stops_on_ctrl_c, converses_after_a_script]
WITH_LIBEDIT = [gives_up_a_line_on_ctrl_c, completes, remembers_lines]


def main(program, *flags):
    failed = 0
    cases = ALWAYS + ([] if "--plain" in flags else WITH_LIBEDIT)
    for case in cases:
        with tempfile.TemporaryDirectory() as folder:
            try:
                case(lambda *arguments: Prompt(program, folder, *arguments))
            except AssertionError as e:
                failed += 1
                print(f"FAILED  {case.__name__}: {e}")
    if "--plain" in flags:
        print("SKIPPED: completion and history: built without libedit")
    print(f"{len(cases) - failed} passed, {failed} failed")
    return 1 if failed else 0


sys.exit(main(*sys.argv[1:]))
