// Writes the object's index.
uniform uint object;

layout(location = 0) out uint object_here;

void main() { object_here = object; }
