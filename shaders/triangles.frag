// Writes the object's index, and the place of its triangle in the scene's indices.
//   RAY_NUMBERS: instead the triangle's number in the scene of shadow rays, of which `object` is the first of
//     the object's triangles
uniform uint object;
uniform uint first_triangle;  // the draw's first

#ifdef RAY_NUMBERS
uniform usamplerBuffer triangle_numbers;  // in the mesh, by place
layout(location = 0) out uint triangle_here;

void main() {
  triangle_here = object + texelFetch(triangle_numbers, int(first_triangle) + gl_PrimitiveID).r;
}
#else
layout(location = 0) out uvec2 triangle_here;

void main() { triangle_here = uvec2(object, first_triangle + uint(gl_PrimitiveID)); }
#endif
