// Two materials, 2 x 1 x 1 mm each: the body of tests/cases/mesh/mesh_formats_test.cpp.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
Coherence;
Mesh.MeshSizeMin = 1;
Mesh.MeshSizeMax = 1;
Physical Volume("soft") = {1};
Physical Volume("hard") = {2};
left() = Surface In BoundingBox {-0.1, -0.1, -0.1, 0.1, 1.1, 1.1};
right() = Surface In BoundingBox {1.9, -0.1, -0.1, 2.1, 1.1, 1.1};
Physical Surface("left") = {left()};
Physical Surface("right") = {right()};
