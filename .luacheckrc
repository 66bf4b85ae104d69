std = "lua54"
max_line_length = 120
read_globals = { "aib", "help" }
-- Stubs: declarations without bodies.
files["lua/meta"] = { ignore = { "1", "2", "4" }, unused_args = false, max_line_length = false }
