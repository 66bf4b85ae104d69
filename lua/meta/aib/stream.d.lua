---@meta aib.stream

---Files larger than memory.
---@class aib.stream
local stream = {}

---@class aib.StreamOptions: aib.CompareOptions
---@field memory? string  # "2GB" (default), "500MB": what the search may take, at least 16.8 MB
---@field folder? string  # for temporary files, without names and gone at the end; about 44 bytes a point of both
---@field progress? fun(share: number)  # called with 0..1

---What `aib.cloud.compare` says of the clouds of two binary PLY files, bit for bit, in bounded memory.
---@param est_path string
---@param ref_path string
---@param options? aib.StreamOptions
---@return aib.Comparison comparison
function stream.compare_clouds(est_path, ref_path, options) end

return stream
