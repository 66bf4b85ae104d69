-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Vectors of three numbers as lists.
local M = {}

function M.add(a, b) return { a[1] + b[1], a[2] + b[2], a[3] + b[3] } end
function M.sub(a, b) return { a[1] - b[1], a[2] - b[2], a[3] - b[3] } end
function M.mul(a, s) return { a[1] * s, a[2] * s, a[3] * s } end
function M.dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
function M.length(a) return math.sqrt(M.dot(a, a)) end
function M.unit(a) return M.mul(a, 1 / M.length(a)) end

function M.cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end

--- The point at a share of the way from a to b.
function M.between(a, b, share) return M.add(a, M.mul(M.sub(b, a), share)) end

return M
