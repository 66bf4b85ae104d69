---@meta aib.render

---Ground truth by ray casting: what a camera sees of a mesh. Pixel centres lie at + 0.5, every camera model is known, no
---ray slips between two triangles that share an edge. Depth equals Blender's Z pass.
---@class aib.render
local render = {}

---A mesh under a tree for rays, for many frames and questions.
---@class aib.RenderScene
---@field n_triangles integer
---@field label_names string[]
local render_scene = {}

---Makes the tree of a mesh, once for many calls; triangles that are not finite are left out.
---@param mesh aib.Mesh
---@return aib.RenderScene scene
function render.scene(mesh) end

---@class aib.RenderOptions
---@field width? integer  # of the maps; those of the camera by default. Another size sees the same field of view
---@field height? integer
---@field background? integer  # label where nothing is seen, 65535

---Maps of one view, all of one size.
---@class aib.RenderedFrame
---@field depth aib.DepthMap  # planar, 0 where nothing is seen
---@field range aib.DepthMap  # distance from the camera's centre, 0 where nothing is seen
---@field normals aib.Array  # H x W x 3, unit, in the camera (right, down, forward), towards it; 0 where there is none
---@field labels aib.LabelImage  # of the faces; background where nothing is seen
---@field n_hit integer  # pixels that see something

---Depth, range, normals and labels of a view, of one cast.
---@param scene aib.RenderScene|aib.Mesh
---@param camera aib.Camera
---@param pose aib.Pose  # world from camera
---@param options? aib.RenderOptions
---@return aib.RenderedFrame frame
function render.frame(scene, camera, pose, options) end

---The depth of a view alone: planar, or the distance from the camera's centre.
---@param scene aib.RenderScene|aib.Mesh
---@param camera aib.Camera
---@param pose aib.Pose  # world from camera
---@param options? { width?: integer, height?: integer, kind?: "planar"|"range" }
---@return aib.DepthMap depth
function render.depth(scene, camera, pose, options) end

---@class aib.RenderFramesOptions : aib.RenderOptions
---@field folder string  # where depth/NAME.exr, range/NAME.exr, normals/NAME.npy and labels/NAME.png (16 bits) go
---@field maps? ("depth"|"range"|"normals"|"labels")[]  # { "depth" } by default
---@field frames? integer[]  # these alone, from 1
---@field existing? "replace"|"keep"  # keep: a frame whose files are all there is left as it is

---Renders frames into a folder, as many at a time as there are threads. Files are named as the images, without their
---extension, and written whole or not at all.
---@param scene aib.RenderScene|aib.Mesh
---@param trajectory aib.Trajectory  # with names
---@param cameras aib.Camera|table<string, aib.Camera>
---@param options aib.RenderFramesOptions
---@return { n_frames: integer, n_kept: integer, files: string[] } written
function render.frames(scene, trajectory, cameras, options) end

---How many views see each point: it lies in their image and the mesh does not hide it.
---@param scene aib.RenderScene|aib.Mesh
---@param points aib.Cloud
---@param trajectory aib.Trajectory
---@param cameras aib.Camera|table<string, aib.Camera>
---@param options? { tolerance?: number }  # what is nearer by a smaller share of the distance does not hide: 0.001
---@return integer[] n_views  # one a point
function render.visible(scene, points, trajectory, cameras, options) end

---What views say of points: on the surface, in free space (a view looks through it: a phantom), or hidden from all.
---@class aib.FreeSpace
---@field n_surface integer
---@field n_free integer
---@field n_hidden integer
---@field free_share number  # of all points
---@field free aib.Cloud  # the phantoms
---@field verdicts ("surface"|"free"|"hidden")[]  # one a point

---Finds the points that hang in free space.
---@param scene aib.RenderScene|aib.Mesh
---@param points aib.Cloud
---@param trajectory aib.Trajectory
---@param cameras aib.Camera|table<string, aib.Camera>
---@param options? { tolerance?: number }  # on the surface is what is not farther from it: 0.05
---@return aib.FreeSpace verdict
function render.free_space(scene, points, trajectory, cameras, options) end

return render
