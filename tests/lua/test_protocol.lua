-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

local aib = require "aib"

local scratch = os.tmpname()
os.remove(scratch)

--- Runs a protocol with its standard streams caught; gives the exit code and both texts.
local function call(protocol, arguments)
  local out, err = {}, {}
  local stdout, stderr = io.stdout, io.stderr
  local function catch(list)
    return { write = function(_, ...) for _, text in ipairs { ... } do list[#list + 1] = text end end }
  end
  io.stdout, io.stderr = catch(out), catch(err)  -- luacheck: ignore 122
  local ok, code = pcall(protocol.main, protocol, arguments)
  io.stdout, io.stderr = stdout, stderr  -- luacheck: ignore 122
  if not ok then error(code, 0) end
  return code, table.concat(out), table.concat(err)
end

local function protocol_with(inputs, run)
  run = run or function() end
  return aib.protocol { name = "demo", help = "Says things.", cite = "Nobody 2026", inputs = inputs, run = run }
end

--- The values that the protocol's run is given.
local function values_of(inputs, arguments)
  local got
  local code, _, err = call(protocol_with(inputs, function(input) got = input end), arguments)
  return got, code, err
end

--- What is said about a command line that is not understood.
local function refusal(t, inputs, arguments)
  local _, code, err = values_of(inputs, arguments)
  t:equal(code, 2)
  return err
end

return aib.test {
  ["every kind of input is read from the command line"] = function(t)
    local inputs = {
      number = { kind = "number", unit = "m" }, count = { kind = "integer" },
      rule = { kind = "choice", choices = { "a", "b" } }, tau = { kind = "list", of = "number", unit = "m" },
      fast = { kind = "flag" }, slow = { kind = "flag", default = true },
      out_path = { kind = "path" }, names = { kind = "list", default = { "x" } },
    }
    t:equal(values_of(inputs, { "--number", "5cm", "--count=3", "--rule", "b", "--tau", "1mm,2", "--tau=3km", "--fast",
      "--no-slow", "--out-path", "-" }), {
      number = 0.05, count = 3, rule = "b", tau = { 0.001, 2, 3000 }, fast = true, slow = false, out_path = "-",
      names = { "x" },
    })
  end,

  ["inputs that have to be given are given by place, in the order of their names or positions"] = function(t)
    local inputs = { est = { kind = "path" }, ref = { kind = "path" }, n = { kind = "integer", default = 1 } }
    t:equal(values_of(inputs, { "a", "b" }), { est = "a", ref = "b", n = 1 })
    t:equal(values_of(inputs, { "--ref=b", "a", "--n", "2" }), { est = "a", ref = "b", n = 2 })
    inputs.ref.position, inputs.est.position = 1, 2
    t:equal(values_of(inputs, { "b", "--", "--a" }), { est = "--a", ref = "b", n = 1 })
    t:equal(values_of({ files = { kind = "list", position = 1 } }, { "a", "b", "c" }), { files = { "a", "b", "c" } })
    local several = { est = { kind = "list" }, ref = { kind = "path" } }
    t:equal(values_of(several, { "a", "b", "c" }), { est = { "a", "b" }, ref = "c" })
    t:equal(values_of(several, { "a", "--ref", "r", "b" }), { est = { "a", "b" }, ref = "r" })
  end,

  ["units of one kind are converted"] = function(t)
    local function value(unit, text) return values_of({ x = { kind = "number", unit = unit } }, { text }).x end
    t:equal(value("m", "250mm"), 0.25)
    t:near(value("deg", "3.141592653589793rad"), 180, 1e-13)
    t:equal(value("B", "2GB"), 2e9)
    t:equal(value("B", "2GiB"), 2 ^ 31)
    t:equal(value("s", "2min"), 120)
    t:equal(value("px", "3px"), 3)
  end,

  ["an unknown option is refused with a suggestion"] = function(t)
    t:equal(refusal(t, { samples = { kind = "integer", default = 1 } }, { "--smaples", "3" }),
      "demo: unknown option '--smaples', did you mean '--samples'? (see --help)\n")
    t:contains(refusal(t, {}, { "-x" }), "unknown option '-x'")
  end,

  ["a value that is none of its kind is refused"] = function(t)
    local function says(input, text, sentence)
      input.default = input.default or nil
      t:equal(refusal(t, { key = input }, { "--key", text }), ("demo: KEY: %s (see --help)\n"):format(sentence))
    end
    says({ kind = "number" }, "far", "a number expected, found 'far'")
    says({ kind = "number" }, "3m", "a number without unit expected, found '3m'")
    says({ kind = "number", unit = "m" }, "3kg", "a number in m expected, found '3kg'")
    says({ kind = "number", min = 0 }, "-1", "at least 0 expected, found '-1'")
    says({ kind = "number", above = 0 }, "0", "more than 0 expected, found '0'")
    says({ kind = "list", of = "number", above = 0 }, "1,-1", "more than 0 expected, found '-1'")
    says({ kind = "number" }, "1e999", "a number expected, found '1e999'")
    says({ kind = "number", max = 1 }, "2", "at most 1 expected, found '2'")
    says({ kind = "integer" }, "1.5", "an integer expected, found '1.5'")
    says({ kind = "integer" }, "1e400", "an integer expected, found '1e400'")
    says({ kind = "choice", choices = { "centre", "floor" } }, "center",
      "one of centre, floor expected, found 'center', did you mean 'centre'?")
    says({ kind = "choice", choices = { "centre", "floor" } }, "edge", "one of centre, floor expected, found 'edge'")
    says({ kind = "path" }, "a\0b", "a path expected, found 'a\0b'")
    says({ kind = "file" }, "a\0b", "a path expected, found 'a\0b'")
    t:contains(refusal(t, { key = { kind = "file", default = "a\0b" } }, {}), "a path expected, found 'a\0b'")
    says({ kind = "list", of = "integer" }, "1,x", "an integer expected, found 'x'")
    says({ kind = "flag", default = nil, position = 1 }, "maybe", "true or false expected, found 'maybe'")
    says({ kind = "path" }, "", "a path expected, found ''")
    says({ kind = "output" }, "/no/such/x.csv", "/no/such: no such folder")
    says({ kind = "output" }, "/", "/: a file expected, found a folder")
    says({ kind = "output", ending = ".png" }, "x.jpg", "a name that ends in .png expected, found 'x.jpg'")
  end,

  ["a command line that is not complete is refused"] = function(t)
    local inputs = { est = { kind = "path", help = "the estimate" } }
    t:contains(refusal(t, inputs, {}), "EST is missing (the estimate)")
    t:contains(refusal(t, inputs, { "a", "b" }), "1 argument at most expected, found 'b' too")
    t:contains(refusal(t, {}, { "a" }), "no argument expected, found 'a' too")
    t:contains(refusal(t, { est = { kind = "path", position = 1 }, cite = { kind = "text" } }, {}), "EST is missing")
    t:contains(refusal(t, inputs, { "a", "--json" }), "--json: a value is missing")
    t:contains(refusal(t, inputs, { "a", "--quiet=1" }), "--quiet takes no value")
    t:contains(refusal(t, inputs, { "a", "--json", "/no/such/x.json" }), "--json: /no/such: no such folder")
    t:contains(refusal(t, inputs, { "a", "--json=" }), "--json: a path expected, found ''")
    t:contains(refusal(t, inputs, { "a", "--json", "/" }), "--json: /: a file expected, found a folder")
    t:contains(refusal(t, inputs, { "a", "--help=1" }), "--help takes no value, found '1'")
    t:contains(refusal(t, inputs, { "a", "--est" }), "--est: a value is missing")
    t:contains(refusal(t, inputs, { "a", "--threads" }), "--threads: a value is missing")
    t:contains(refusal(t, inputs, { "a", "--threads=two" }), "--threads: an integer expected, found 'two'")
    t:contains(refusal(t, inputs, { "a", "--threads", "-1" }), "--threads: at least 0 expected, found '-1'")
    t:contains(refusal(t, inputs, { "a", "--sandbox" }), "--sandbox goes before the name: aib-lua --sandbox demo")
  end,

  ["a file that is not there is a bad input"] = function(t)
    local _, code, err = values_of({ est = { kind = "file" } }, { "/no/such/file" })
    t:equal(code, 3)
    t:equal(err, "demo: /no/such/file: no such file\n")
    _, code, err = values_of({ est = { kind = "file" } }, { "/" })
    t:equal(code, 3)
    t:equal(err, "demo: /: a file expected, found a folder\n")
    _, code, err = values_of({ dir = { kind = "folder" } }, { "/no/such" })
    t:equal(code, 3)
    t:equal(err, "demo: /no/such: no such folder\n")
    _, code, err = values_of({ dir = { kind = "folder" } }, { arg[0] })
    t:equal({ code, err }, { 3, ("demo: %s: a folder expected, found a file\n"):format(arg[0]) })
  end,

  ["a result that cannot be written is no bad input"] = function(t)
    local says <const> = "/dev/full: cannot write: No space left on device"
    local ok, message = pcall(aib.system.write_text, "/dev/full", "x")
    t:check(not ok)
    t:contains(message, says)
    t:equal(aib.error_kind(message), "output")
    local code, _, err = call(protocol_with {}, { "--quiet", "--json", "/dev/full" })
    t:equal({ code, err }, { 1, ("demo: %s\n"):format(says) })
    local protocol = protocol_with({}, function() aib.system.write_text("/dev/full", "x") end)
    code, _, err = call(protocol, { "--quiet" })
    t:equal({ code, err }, { 1, ("demo: %s\n"):format(says) })
  end,

  ["help lists inputs, defaults, choices and result files"] = function(t)
    local code, out = call(protocol_with {
      est = { kind = "file", help = "the estimate" },
      rule = { kind = "choice", choices = { "centre", "floor" }, default = "centre", help = "which pixel" },
    }, { "--help" })
    t:equal(code, 0)
    t:equal(out, [[
usage: aib-lua demo [options] EST

Says things.

  EST                     the estimate

options:
  --rule centre|floor     which pixel (default centre)

results:
  --json FILE             every number with its convention, options and sources
  --csv FILE              the records, a line each
  --markdown FILE         the tables as Markdown
  --latex FILE            the tables as LaTeX (booktabs)
  --html FILE             a page that opens from disk: tables, charts, frames,
                          3-D
  --quiet                 print nothing but errors
  --threads N             threads of the library (0, the default: all)

cite: Nobody 2026
]])
  end,

  ["help tells which options have to be given"] = function(t)
    local _, out = call(protocol_with { depth = { kind = "folder", position = 1 }, out = { kind = "output" } },
      { "--help" })
    t:contains(out, "usage: aib-lua demo [options] --out FILE DEPTH\n")
  end,

  ["a declaration that is wrong is an error at its line"] = function(t)
    local function declare(spec) return function() aib.protocol(spec) end end
    local run = function() end
    t:raises("test_protocol.lua:", declare { name = "x" })
    t:raises("aib.protocol: run: a function expected", declare { name = "x" })
    t:raises("aib.protocol: name: a string expected", declare { run = run })
    t:raises("aib.protocol: unknown field 'input', did you mean 'inputs'?",
      declare { name = "x", run = run, input = {} })
    local function input(key, spec) return declare { name = "x", run = run, inputs = { [key] = spec } } end
    t:raises("input 'a': unknown kind 'file_name' (known: choice, file,", input("a", { kind = "file_name" }))
    t:raises("input 'a': unknown kind 'fiel', did you mean 'file'?", input("a", { kind = "fiel" }))
    t:raises("input 'a': unknown field 'hlep', did you mean 'help'?", input("a", { kind = "file", hlep = "x" }))
    t:raises("input 'a': choices: a list of names expected", input("a", { kind = "choice" }))
    t:raises("input 'a': choices: a list of names expected", input("a", { kind = "list", of = "choice", choices = {} }))
    t:raises("input 'a': choices: names expected, found number", input("a", { kind = "choice", choices = { 1 } }))
    t:raises("input 'a': unknown kind 'fiel', did you mean 'file'?", input("a", { kind = "list", of = "fiel" }))
    t:raises("input 'a': of: a kind of one value expected", input("a", { kind = "list", of = "list" }))
    t:raises("input 'a': min: a number expected, found string", input("a", { kind = "number", min = "0" }))
    t:raises("input 'a': above: a number expected, found string", input("a", { kind = "number", above = "0" }))
    t:raises("input 'a': help: a string expected, found number", input("a", { kind = "number", help = 3 }))
    t:raises("input 'a': an integer expected, found string", input("a", { kind = "integer", default = "3" }))
    t:raises("input 'json': the name is taken", input("json", { kind = "file" }))
    t:raises("input 'a b': a name of letters, digits and _ expected", input("a b", { kind = "file" }))
    t:raises("test_protocol.lua:", input("a", { kind = "fiel" }))
    t:raises("aib.protocol: a table expected, found nil", aib.protocol)
    t:raises("aib.protocol: help: a string expected, found number", declare { name = "x", run = run, help = 3 })
    t:raises("input 'a': a table expected, found string", input("a", "file"))
    t:raises("input 'a': a list expected, found string", input("a", { kind = "list", default = "x" }))
    t:raises("input 'threads': the name is taken by every protocol's --threads", input("threads", { kind = "integer" }))
  end,

  ["an undefined metric is a dash with a note and no failure"] = function(t)
    local code, out = call(protocol_with({}, function(_, report)
      report:add("mean", function() return aib.stats.summary({}).mean end)
      report:add("n", 1)
    end), {})
    t:equal(code, 0)
    t:contains(out, "mean   –\n")
    t:contains(out, "• mean: stats::summarize: no values\n")
  end,

  ["an undefined metric that nobody guards ends the run with a note and no failure"] = function(t)
    local code, out = call(protocol_with({}, function(_, report)
      report:add("n", 1)
      report:add("mean", aib.stats.summary({}).mean)
    end), {})
    t:equal(code, 0)
    t:contains(out, "• the evaluation ended early: stats::summarize: no values\n")
  end,

  ["a mistake of the script is told with its line and leaves no result"] = function(t)
    local code, out, err = call(protocol_with({}, function() local x = nil; return x.y end), { "--json", scratch })
    t:equal(code, 1)
    t:equal(out, "")
    t:contains(err, "test_protocol.lua:")
    t:contains(err, "attempt to index a nil value")
    t:contains(err, "in field 'body'")  -- where it began, not where it was passed on
    t:check(not aib.system.is_file(scratch))
  end,

  ["what the library refuses is a sentence with the script's line"] = function(t)
    local code, _, err = call(protocol_with({}, function() aib.stats.quantile({ 1, 2 }, 3) end), {})
    t:equal(code, 1)
    t:check(err:find "^demo: [^\n]*%(.*test_protocol%.lua:%d+%)\n$", err)
  end,

  ["an input file that is bad is one sentence and leaves no result"] = function(t)
    local code, out, err = call(protocol_with({}, function(_, report)
      report:add("n", 1)
      aib.system.read_text("/no/such/file")
    end), { "--json", scratch, "--csv", scratch })
    t:equal(code, 3)
    t:equal(out, "")
    t:equal(err, "demo: /no/such/file: cannot open: No such file or directory\n")
    t:check(not aib.system.is_file(scratch))
  end,

  ["a lack of memory is a sentence, whoever lacks it"] = function(t)
    for _, text in ipairs { "not enough memory", "p.lua:3: not enough memory" } do
      local code, _, err = call(protocol_with({}, function() error(text, 0) end), {})
      t:equal(code, 1)
      t:equal(err, "demo: not enough memory\n")
    end
  end,

  ["every format is written, and quiet prints nothing"] = function(t)
    local names, arguments = {}, { "--quiet" }
    for _, format in ipairs { "json", "csv", "markdown", "latex", "html" } do
      names[format] = scratch .. "." .. format
      table.move({ "--" .. format, names[format] }, 1, 2, #arguments + 1, arguments)
    end
    local code, out = call(protocol_with({}, function(_, report) report:add("n", 41) end), arguments)
    t:equal(code, 0)
    t:equal(out, "")
    for _, name in pairs(names) do
      t:contains(aib.system.read_text(name), "41")
      os.remove(name)
    end
  end,

  ["JSON names an input file by its name and content"] = function(t)
    local path = scratch .. "_a.txt"
    aib.system.write_text(path, "abc")
    local report = protocol_with({ est = { kind = "file" }, k = { kind = "integer", default = 3 } }):run { est = path }
    os.remove(path)
    local name = path:match("[^/]*$")
    local read = aib.json.decode(require("aib.report.json")(report))
    t:equal(read.inputs, { est = name, k = 3 })
    t:equal(read.sources[name], { bytes = 3,
      sha256 = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad" })
    t:check(not require("aib.report.json")(report):find(path, 1, true))
  end,

  ["a protocol runs from Lua and says what is wrong with its inputs"] = function(t)
    local p = protocol_with({ k = { kind = "integer", max = 5 } }, function(input, report) report:add("k", input.k) end)
    t:equal(p:run({ k = 3.0 }):records()[1].value, 3)
    t:raises("demo: K: at most 5 expected, found '7'", p.run, p, { k = 7 })
    t:raises("demo: K: an integer expected, found string", p.run, p, { k = "3" })
    t:raises("demo: K: an integer expected, found '", p.run, p, { k = 0 / 0 })
    t:raises("demo: unknown input 'kk', did you mean 'k'?", p.run, p, { kk = 1 })
    t:raises("demo: K is missing", p.run, p, {})
    t:equal(tostring(p), "protocol(demo)")
  end,
}
