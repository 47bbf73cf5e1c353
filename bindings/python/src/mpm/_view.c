/* Memory of the library as buffers of Python. A lease gives a view back to the library when the last array over it has
 * died. What is lent for the time of a callback alone is copied, and put back, because nothing tells an array that its
 * memory is gone. Functions and addresses come from ctypes, so that the module is linked to nothing but Python. */
#define Py_LIMITED_API 0x030b0000
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#include <stdint.h>
#include <string.h>

typedef int32_t (*release_fn)(void *view);

typedef struct lease {
  PyObject_HEAD void *data;
  Py_ssize_t shape[2], strides[2], item_size, exports;
  char format[2];
  int dimensions, writable, lent;
  release_fn release;
  void *view;      /* the struct that the library has filled, kept alive by owner */
  PyObject *owner; /* what must outlive the lease */
  PyObject *ended; /* called with the status of the release */
} lease;

/* Gives the view back to the library, and tells what it said. The error that may be under way stays. */
static void give_back(lease *self) {
  PyObject *type, *value, *trace, *said;
  int32_t status;
  if (!self->lent) return;
  self->lent = 0;
  status = self->release(self->view);
  PyErr_Fetch(&type, &value, &trace);
  said = PyObject_CallFunction(self->ended, "i", (int)status);
  if (!said) PyErr_WriteUnraisable(self->ended);
  Py_XDECREF(said);
  PyErr_Restore(type, value, trace);
}

/* The arguments are the address, format and size of an item, rows and columns (0: there is one axis) with their distances
 * in items, whether it may be written, the function that gives the view back, its address, what must outlive it, and
 * who is told the status. */
static PyObject *lease_new(PyTypeObject *type, PyObject *args, PyObject *keywords) {
  unsigned long long data, release, view;
  Py_ssize_t item_size, rows, columns, row_stride, column_stride;
  const char *format;
  int writable;
  PyObject *owner, *ended;
  lease *self;
  if (keywords && PyDict_Size(keywords)) {
    PyErr_SetString(PyExc_TypeError, "a lease takes no keywords");
    return NULL;
  }
  if (!PyArg_ParseTuple(args, "KsnnnnnpKKOO", &data, &format, &item_size, &rows, &columns, &row_stride,
                        &column_stride, &writable, &release, &view, &owner, &ended))
    return NULL;
  self = (lease *)((allocfunc)PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (!self) return NULL;
  self->data = (void *)(uintptr_t)data;
  self->format[0] = format[0];
  self->item_size = item_size;
  self->dimensions = columns > 0 ? 2 : 1;
  self->shape[0] = rows;
  self->shape[1] = columns;
  self->strides[0] = row_stride * item_size;
  self->strides[1] = column_stride * item_size;
  self->writable = writable;
  self->lent = 1;
  self->release = (release_fn)(uintptr_t)release;
  self->view = (void *)(uintptr_t)view;
  Py_INCREF(owner);
  self->owner = owner;
  Py_INCREF(ended);
  self->ended = ended;
  return (PyObject *)self;
}

static void lease_free(PyObject *object) {
  lease *self = (lease *)object;
  PyTypeObject *type = Py_TYPE(object);
  give_back(self);
  Py_XDECREF(self->owner);
  Py_XDECREF(self->ended);
  ((freefunc)PyType_GetSlot(type, Py_tp_free))(object);
  Py_DECREF(type);
}

static int lease_get(PyObject *object, Py_buffer *buffer, int flags) {
  lease *self = (lease *)object;
  buffer->obj = NULL;
  if (!self->lent) {
    PyErr_SetString(PyExc_BufferError, "the view has been given back to the library");
    return -1;
  }
  if ((flags & PyBUF_WRITABLE) && !self->writable) {
    PyErr_SetString(PyExc_BufferError, "the view is for reading");
    return -1;
  }
  if ((flags & PyBUF_STRIDES) != PyBUF_STRIDES) {
    PyErr_SetString(PyExc_BufferError, "the view has strides");
    return -1;
  }
  Py_INCREF(object);
  buffer->obj = object;
  buffer->buf = self->data;
  buffer->len = self->shape[0] * (self->dimensions > 1 ? self->shape[1] : 1) * self->item_size;
  buffer->itemsize = self->item_size;
  buffer->readonly = !self->writable;
  buffer->ndim = self->dimensions;
  buffer->format = (flags & PyBUF_FORMAT) ? self->format : NULL;
  buffer->shape = self->shape;
  buffer->strides = self->strides;
  buffer->suboffsets = NULL;
  buffer->internal = NULL;
  ++self->exports;
  return 0;
}

static void lease_release(PyObject *object, Py_buffer *buffer) {
  lease *self = (lease *)object;
  (void)buffer;
  if (--self->exports == 0) give_back(self);
}

static PyType_Slot lease_slots[] = {
    {Py_tp_doc, "Memory of the library, given back when its last buffer dies."},
    {Py_tp_new, lease_new},
    {Py_tp_dealloc, lease_free},
    {Py_bf_getbuffer, lease_get},
    {Py_bf_releasebuffer, lease_release},
    {0, NULL}};
static PyType_Spec lease_spec = {"mpm._view.Lease", sizeof(lease), 0, Py_TPFLAGS_DEFAULT, lease_slots};

/* Rows of bytes, a stride apart, one after the other: bytes, or a bytearray for what is to be written. */
static PyObject *copied(PyObject *module, PyObject *args) {
  unsigned long long at;
  Py_ssize_t rows, bytes, stride;
  int writable;
  PyObject *copy;
  const char *from;
  char *to;
  (void)module;
  if (!PyArg_ParseTuple(args, "Knnnp", &at, &rows, &bytes, &stride, &writable)) return NULL;
  copy = (writable ? PyByteArray_FromStringAndSize : PyBytes_FromStringAndSize)(NULL, rows * bytes);
  if (!copy) return NULL;
  to = writable ? PyByteArray_AsString(copy) : PyBytes_AsString(copy);
  from = (const char *)(uintptr_t)at;
  for (Py_ssize_t r = 0; r < rows; ++r) memcpy(to + r * bytes, from + r * stride, (size_t)bytes);
  return copy;
}

/* Puts a bytearray that copied() has made back where it came from. */
static PyObject *put_back(PyObject *module, PyObject *args) {
  unsigned long long at;
  Py_ssize_t rows, bytes, stride;
  PyObject *copy;
  const char *from;
  char *to;
  (void)module;
  if (!PyArg_ParseTuple(args, "YKnnn", &copy, &at, &rows, &bytes, &stride)) return NULL;
  from = PyByteArray_AsString(copy);
  to = (char *)(uintptr_t)at;
  for (Py_ssize_t r = 0; r < rows; ++r) memcpy(to + r * stride, from + r * bytes, (size_t)bytes);
  Py_RETURN_NONE;
}

static PyMethodDef functions[] = {
    {"copied", copied, METH_VARARGS, "copied(at, rows, bytes, stride, writable): bytes, or a bytearray."},
    {"put_back", put_back, METH_VARARGS, "put_back(copy, at, rows, bytes, stride): the other way."},
    {NULL, NULL, 0, NULL}};

static int fill_module(PyObject *module) {
  PyObject *type = PyType_FromSpec(&lease_spec);
  int failed = !type || PyModule_AddObjectRef(module, "Lease", type);
  Py_XDECREF(type);
  return failed ? -1 : 0;
}
static PyModuleDef_Slot slots[] = {{Py_mod_exec, (void *)fill_module}, {0, NULL}};
static struct PyModuleDef definition = {
    PyModuleDef_HEAD_INIT, "_view", "Memory of libmpm as buffers.", 0, functions, slots, NULL, NULL, NULL};
PyMODINIT_FUNC PyInit__view(void) {
  return PyModuleDef_Init(&definition);
}
