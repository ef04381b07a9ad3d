// A block of 20 x 20 x 12 mm with a hole, meshed by tetrahedra, to be replaced.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 20, 20, 12};
Cylinder(2) = {10, -1, 6, 0, 22, 0, 3};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 3.5;
bottom() = Surface In BoundingBox {-1, -1, -0.1, 21, 21, 0.1};
top() = Surface In BoundingBox {-1, -1, 11.9, 21, 21, 12.1};
Physical Surface("bottom") = {bottom()};
Physical Surface("top") = {top()};
Physical Volume("tissue") = {3};
