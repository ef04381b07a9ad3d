"""A sparse Cholesky factorisation by CHOLMOD (libcholmod.so.3 of suitesparse 5), called without a binding."""

import ctypes

import numpy as np


class Cholesky:
    """Factors of a symmetric positive definite matrix whose upper triangle is given."""

    class Sparse(ctypes.Structure):
        _fields_ = [("nrow", ctypes.c_size_t), ("ncol", ctypes.c_size_t), ("nzmax", ctypes.c_size_t), ("p", ctypes.c_void_p),
                    ("i", ctypes.c_void_p), ("nz", ctypes.c_void_p), ("x", ctypes.c_void_p), ("z", ctypes.c_void_p),
                    ("stype", ctypes.c_int), ("itype", ctypes.c_int), ("xtype", ctypes.c_int), ("dtype", ctypes.c_int),
                    ("sorted", ctypes.c_int), ("packed", ctypes.c_int)]

    class Dense(ctypes.Structure):
        _fields_ = [("nrow", ctypes.c_size_t), ("ncol", ctypes.c_size_t), ("nzmax", ctypes.c_size_t), ("d", ctypes.c_size_t),
                    ("x", ctypes.POINTER(ctypes.c_double)), ("z", ctypes.c_void_p), ("xtype", ctypes.c_int), ("dtype", ctypes.c_int)]

    library = None

    def __init__(self):
        if Cholesky.library is None:
            Cholesky.library = ctypes.CDLL("libcholmod.so.3")
            for name in ("analyze", "solve"):
                getattr(Cholesky.library, f"cholmod_{name}").restype = ctypes.c_void_p
        self.common = ctypes.create_string_buffer(1 << 16)
        self.library.cholmod_start(self.common)
        self.factor = None

    def factorise(self, upper):
        self.n = upper.shape[0]
        self.kept = upper.indptr.astype(np.int32), upper.indices.astype(np.int32), upper.data
        pointers = [array.ctypes.data for array in self.kept]
        matrix = self.Sparse(self.n, self.n, len(self.kept[2]), pointers[0], pointers[1], None, pointers[2], None, 1, 0, 1, 0, 1, 1)
        if self.factor is None:
            self.factor = ctypes.c_void_p(self.library.cholmod_analyze(ctypes.byref(matrix), self.common))
        self.library.cholmod_factorize(ctypes.byref(matrix), self.factor, self.common)

    def solve(self, b):
        b = np.ascontiguousarray(b)
        right = self.Dense(self.n, 1, self.n, self.n, b.ctypes.data_as(ctypes.POINTER(ctypes.c_double)), None, 1, 0)
        found = ctypes.c_void_p(self.library.cholmod_solve(0, self.factor, ctypes.byref(right), self.common))
        x = np.ctypeslib.as_array(ctypes.cast(found, ctypes.POINTER(self.Dense)).contents.x, (self.n,)).copy()
        self.library.cholmod_free_dense(ctypes.byref(found), self.common)
        if not np.all(np.isfinite(x)):
            raise ArithmeticError("the matrix is not positive definite")
        return x

    def free(self):
        if self.factor is not None:
            self.library.cholmod_free_factor(ctypes.byref(self.factor), self.common)
        self.library.cholmod_finish(self.common)
