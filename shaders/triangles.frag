// Writes the object's index, and the place of its triangle in the scene's indices.
uniform uint object;
uniform uint first_triangle;  // of the draw

layout(location = 0) out uvec2 triangle_here;

void main() { triangle_here = uvec2(object, first_triangle + uint(gl_PrimitiveID)); }
