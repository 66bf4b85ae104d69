// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// @file
/// Readers and writers.

#include <aib/io/array_cloud.hpp>
#include <aib/io/array_depth.hpp>
#include <aib/io/axes.hpp>
#include <aib/io/byte_stream.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/cloud.hpp>
#include <aib/io/cloud_stream.hpp>
#include <aib/io/colmap.hpp>
#include <aib/io/colmap_binary.hpp>
#include <aib/io/colmap_depth.hpp>
#include <aib/io/colmap_records.hpp>
#include <aib/io/colmap_text.hpp>
#include <aib/io/colmap_write.hpp>
#include <aib/io/da3_streaming.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/depth_frame.hpp>
#include <aib/io/dmap.hpp>
#include <aib/io/euroc.hpp>
#include <aib/io/exr_header.hpp>
#include <aib/io/exr_piz.hpp>
#include <aib/io/exr_predictor.hpp>
#include <aib/io/file.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/fingerprint.hpp>
#include <aib/io/float_pixels.hpp>
#include <aib/io/frame_stack.hpp>
#include <aib/io/half.hpp>
#include <aib/io/image.hpp>
#include <aib/io/kitti.hpp>
#include <aib/io/las.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/mesh.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/number_lines.hpp>
#include <aib/io/numbers.hpp>
#include <aib/io/obj.hpp>
#include <aib/io/pcd.hpp>
#include <aib/io/pfm.hpp>
#include <aib/io/ply.hpp>
#include <aib/io/ply_data.hpp>
#include <aib/io/ply_header.hpp>
#include <aib/io/ply_positions.hpp>
#include <aib/io/ply_write.hpp>
#include <aib/io/pose_arrays.hpp>
#include <aib/io/pose_format.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/posed_images.hpp>
#include <aib/io/positions.hpp>
#include <aib/io/range_depth.hpp>
#include <aib/io/raw_depth.hpp>
#include <aib/io/reality_capture.hpp>
#include <aib/io/stl.hpp>
#include <aib/io/tanks_and_temples.hpp>
#include <aib/io/text.hpp>
#include <aib/io/trajectory.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/io/trajectory_write.hpp>
#include <aib/io/tum.hpp>
#include <aib/io/waypoints.hpp>
#include <aib/io/xyz.hpp>

#if defined(AIB_WITH_EXR) || defined(AIB_WITH_NPZ)
#include <aib/io/exr.hpp>
#include <aib/io/exr_block.hpp>
#include <aib/io/exr_channel.hpp>
#include <aib/io/inflate.hpp>
#include <aib/io/npz.hpp>
#include <aib/io/npz_write.hpp>
#include <aib/io/pose_npz.hpp>
#endif

#if defined(AIB_WITH_JPEG)
#include <aib/io/jpeg.hpp>
#endif

#if defined(AIB_WITH_JSON)
#include <aib/io/glb.hpp>
#include <aib/io/json.hpp>
#include <aib/io/opensfm.hpp>
#include <aib/io/transforms.hpp>
#endif

#if defined(AIB_WITH_PNG)
#include <aib/io/png.hpp>
#endif

#if defined(AIB_WITH_XML)
#include <aib/io/metashape.hpp>
#endif
