-- Hand arrays to numpy and take them back: NPY files, nothing between.
local aib = require "aib"

local folder = os.getenv "TMPDIR" or "/tmp"
local path = folder .. "/aib_example_points.npy"
local mesh = aib.io.read_mesh "examples/data/gt/crane/mesh.ply"
local cloud = aib.sample.mesh(mesh, { n = 1000 })
aib.io.write_array(path, aib.mesh.distances(cloud, mesh)) -- numpy.load(path) is a float32 array
print(aib.io.read_array(path))

aib.io.write_array(path, cloud)
print(aib.io.read_cloud(path))
os.remove(path)
