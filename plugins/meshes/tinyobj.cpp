// The functions of tinyobjloader, once for all readers.
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
