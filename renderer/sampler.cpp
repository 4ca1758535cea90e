#include "renderer/sampler.h"
