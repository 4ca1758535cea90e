#pragma once
// Files that are whole or not there. `neural` has them, which saves models without the renderer.

#include "neural/file/atomic_file.h"

namespace gatelight::renderer {

using neural::AtomicFile;
using neural::check_writable;
using neural::OutputError;
using neural::replaced_file;
using neural::write_file_atomically;

}  // namespace gatelight::renderer
