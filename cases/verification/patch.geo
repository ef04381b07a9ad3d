// A cube of 10 mm in tetrahedra without a pattern: a patch test is no test on cells that are alike.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 10, 10, 10};
Mesh.MeshSizeMax = 4;
x0() = Surface In BoundingBox {-0.1, -1, -1, 0.1, 11, 11};
y0() = Surface In BoundingBox {-1, -0.1, -1, 11, 0.1, 11};
z0() = Surface In BoundingBox {-1, -1, -0.1, 11, 11, 0.1};
z1() = Surface In BoundingBox {-1, -1, 9.9, 11, 11, 10.1};
Physical Surface("x = 0") = {x0()};
Physical Surface("y = 0") = {y0()};
Physical Surface("z = 0") = {z0()};
Physical Surface("z = 10") = {z1()};
Physical Volume("body") = {1};
