// SPDX-License-Identifier: Apache-2.0
// Private to volumes/: .vdb files written whole or not at all, and read with errors that name the file.
#pragma once
#include <openvdb/openvdb.h>

#include <string>

namespace turbid {

/// Registers OpenVDB's types; may be called often and from several threads.
void initialise_vdb();

/// Names a grid, sets its class, the scene unit (`unit`), the unit of its values (`turbid:unit_of_values`) and creator.
void label_grid(openvdb::GridBase&, const std::string& name, openvdb::GridClass, const std::string& unit,
                const std::string& unit_of_values);

/// Writes to `<path>.part`, then renames. On failure removes the part and throws InputError with the reason.
void write_vdb_file(const std::string& path, const openvdb::GridCPtrVec& grids);

/// All grids of a file. Throws InputError if it is missing, unreadable, cut short or no OpenVDB file.
openvdb::GridPtrVec read_vdb_file(const std::string& path);

}  // namespace turbid
