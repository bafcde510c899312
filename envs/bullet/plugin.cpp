#include <lgabench/plugin/plugin.hpp>

#include "bullet/bullet_world.hpp"

LGABENCH_ENGINE("bullet", "0.1", "Bullet 3.24", lgabench::BulletWorld)
