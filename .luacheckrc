std = "lua54"
max_line_length = 120
read_globals = { "aib", "help" }
files["lua/meta"] = { ignore = { "1", "2" }, unused_args = false }  -- stubs: declarations without bodies
