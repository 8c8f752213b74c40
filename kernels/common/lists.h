// A list names (type, name) once for a kernel's parameters, a struct's members and their values.
#pragma once

#define PARAMETER(type, name) type name,
#define MEMBER(type, name) type name;
#define GIVEN(type, name) .name = name,
