-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Writes a generated scene for test_blender.py: write_scene.lua NAME MESH
package.path = (arg[0]:match("^(.*)/[^/]*$") or ".") .. "/../../examples/dataset/?.lua;" .. package.path
require("scenes." .. arg[1]).build():save(arg[2])
