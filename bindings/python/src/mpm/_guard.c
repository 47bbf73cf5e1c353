/* Functions that the library calls, around functions of Python. What these raise cannot pass through the library: it waits
 * in a dict, by thread, for the end of the call that is under way, and the library is told -1. This is C because the
 * interpreter raises what a signal asks for (Ctrl-C) at the entry of a function of Python, before a `try` in it. */
#define Py_LIMITED_API 0x030b0000
#define PY_SSIZE_T_CLEAN
#include <Python.h>
#include <limits.h>
#include <stddef.h>

typedef struct guard {
  PyObject_HEAD PyObject *callback; /* None: only signals are looked for */
  PyObject *raised;                 /* the first exception of each thread, by its ident */
} guard;

/* Puts the exception that is set where the end of the call finds it. */
static void keep(guard *self) {
  PyObject *type, *value, *trace, *thread;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  if (trace) PyException_SetTraceback(value, trace);
  thread = PyLong_FromUnsignedLong(PyThread_get_thread_ident());
  if (!thread || (!PyDict_GetItemWithError(self->raised, thread) &&
                  (PyErr_Occurred() || PyDict_SetItem(self->raised, thread, value))))
    PyErr_WriteUnraisable(self->callback);
  Py_XDECREF(thread);
  Py_XDECREF(type);
  Py_XDECREF(value);
  Py_XDECREF(trace);
}

/* The status that an answer stands for: None for 0, else a whole number. */
static int status_of(PyObject *said, int *status) {
  PyObject *number;
  long value;
  *status = 0;
  if (said == Py_None) return 0;
  number = PyNumber_Long(said);
  if (!number) return -1;
  value = PyLong_AsLong(number);
  Py_DECREF(number);
  if (value == -1 && PyErr_Occurred()) return -1;
  *status = value > INT_MAX ? INT_MAX : value < INT_MIN ? INT_MIN : (int)value;
  return 0;
}

static PyObject *guard_call(PyObject *object, PyObject *arguments, PyObject *keywords) {
  guard *self = (guard *)object;
  int status = 0, failed = PyErr_CheckSignals();
  if (!failed && self->callback != Py_None) {
    PyObject *said = PyObject_Call(self->callback, arguments, keywords);
    failed = !said || status_of(said, &status);
    Py_XDECREF(said);
  }
  if (failed) keep(self);
  return PyLong_FromLong(failed ? -1 : status);
}

/* The arguments are the function and the dict. */
static PyObject *guard_new(PyTypeObject *type, PyObject *arguments, PyObject *keywords) {
  PyObject *callback, *raised;
  guard *self;
  if (keywords && PyDict_Size(keywords)) {
    PyErr_SetString(PyExc_TypeError, "a guard takes no keywords");
    return NULL;
  }
  if (!PyArg_ParseTuple(arguments, "OO!", &callback, &PyDict_Type, &raised)) return NULL;
  self = (guard *)((allocfunc)PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (!self) return NULL;
  Py_INCREF(callback);
  self->callback = callback;
  Py_INCREF(raised);
  self->raised = raised;
  return (PyObject *)self;
}

static int guard_traverse(PyObject *object, visitproc visit, void *arg) {
  guard *self = (guard *)object;
  Py_VISIT(Py_TYPE(object));
  Py_VISIT(self->callback);
  Py_VISIT(self->raised);
  return 0;
}

static int guard_clear(PyObject *object) {
  guard *self = (guard *)object;
  Py_CLEAR(self->callback);
  Py_CLEAR(self->raised);
  return 0;
}

static void guard_free(PyObject *object) {
  PyTypeObject *type = Py_TYPE(object);
  PyObject_GC_UnTrack(object);
  guard_clear(object);
  ((freefunc)PyType_GetSlot(type, Py_tp_free))(object);
  Py_DECREF(type);
}

static PyType_Slot guard_slots[] = {
    {Py_tp_doc, "A function of Python for the library, which is told a status."},
    {Py_tp_new, guard_new},
    {Py_tp_call, guard_call},
    {Py_tp_traverse, guard_traverse},
    {Py_tp_clear, guard_clear},
    {Py_tp_dealloc, guard_free},
    {0, NULL}};
static PyType_Spec guard_spec = {"mpm._guard.Guard", sizeof(guard), 0,
                                 Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_GC, guard_slots};

static int fill_module(PyObject *module) {
  PyObject *type = PyType_FromSpec(&guard_spec);
  int failed = !type || PyModule_AddObjectRef(module, "Guard", type);
  Py_XDECREF(type);
  return failed ? -1 : 0;
}
static PyModuleDef_Slot slots[] = {{Py_mod_exec, (void *)fill_module}, {0, NULL}};
static struct PyModuleDef definition = {
    PyModuleDef_HEAD_INIT, "_guard", "Functions of Python for libmpm.", 0, NULL, slots, NULL, NULL, NULL};
PyMODINIT_FUNC PyInit__guard(void) {
  return PyModuleDef_Init(&definition);
}
