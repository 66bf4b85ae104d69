-- SPDX-FileCopyrightText: the aib authors
-- SPDX-License-Identifier: MIT

--- Both tables in one.
return function(a, b)
  local merged = {}
  for _, options in ipairs { a or {}, b } do
    for key, value in pairs(options) do merged[key] = value end
  end
  return merged
end
