// Contexts, grids and sets of particles.
using System;
using System.Collections.Generic;
using System.IO;
using System.Runtime.InteropServices;
using static Mpm.Constants;

namespace Mpm {
  /// <summary>Memory, threads and log, which all other objects need.</summary>
  public sealed unsafe class Context : Handle {
    /// <summary>A context; threads 0: one per processor. With serialCallbacks functions of the host run on the calling thread
    /// only: leave it so unless they take others.</summary>
    public Context(int threads = 1, int isa = MPM_ISA_BEST, bool serialCallbacks = true, Action<int, string> log = null)
        : base(Create(threads, isa, serialCallbacks, log)) {}

    static Node Create(int threads, int isa, bool serialCallbacks, Action<int, string> log) {
      var core = new Core();
      var node = new Node(core, Native.mpm_context_destroy);
      var desc = ContextDesc.Default();
      desc.concurrency = threads;
      desc.isa = isa;
      desc.serial_callbacks = serialCallbacks ? 1 : 0;
      if (log != null) {
        var slot = new Slot(core, log);
        node.Put("log", slot);
        desc.log = Trampolines.Address(Trampolines.Log);
        desc.log_user = slot.User;
      }
      byte* text = stackalloc byte[1024];
      text[0] = 0;
      desc.error_text = (IntPtr)text;
      desc.error_bytes = 1024;
      return Make(node, made => {
        var services = desc;
        int status = Native.mpm_context_create(&services, made);
        if (status != MPM_OK) throw new MpmException(status, Text.Of(services.error_text));
        core.Pointer = *made;
        return MPM_OK;
      });
    }

    /// <summary>Bytes that the context and its objects hold now. May be called in callbacks.</summary>
    public long Memory {
      get {
        long bytes;
        MpmException.Check(Native.mpm_context_memory(Pointer, &bytes, null), IntPtr.Zero);
        return bytes;
      }
    }
  }

  /// <summary>The background grid.</summary>
  public sealed unsafe class Grid : Handle {
    /// <summary>The dimension, 1 to 3.</summary>
    public int Dim { get; }

    public Grid(Context context, GridDesc desc) : base(Create(context, desc)) {
      Dim = desc.dim;
    }
    static Node Create(Context context, GridDesc desc) {
      desc.struct_size = (uint)sizeof(GridDesc);
      var node = new Node(context.node.Core, Native.mpm_grid_destroy, context.node);
      return Make(node, made => {
        var box = desc;
        return Native.mpm_grid_create(context.Pointer, &box, made);
      });
    }
    /// <summary>A grid of equal cells with the defaults: one number for each axis.</summary>
    public static GridDesc Box(long[] cells, double[] spacing) {
      if (cells.Length != spacing.Length || cells.Length < 1 || cells.Length > 3)
        throw new ArgumentException("cells and spacing have one number for each of one to three axes");
      var desc = GridDesc.Default();
      desc.dim = cells.Length;
      for (int k = 0; k < cells.Length; k++) {
        desc.cells[k] = cells[k];
        desc.spacing[k] = spacing[k];
      }
      return desc;
    }
  }

  /// <summary>A set of particles of one material on one grid. T of its fields is double, long or byte.</summary>
  public sealed unsafe class Particles : Handle {
    public int Dim { get; }

    public Particles(Context context, Grid grid, Material material) : base(Create(context, grid, material)) {
      Dim = grid.Dim;
    }
    static Node Create(Context context, Grid grid, Material material) {
      var node = new Node(context.node.Core, Native.mpm_particles_destroy, context.node, grid.node, material.node);
      return Make(node, made => Native.mpm_particles_create(context.Pointer, grid.Pointer, material.Pointer, made));
    }

    /// <summary>The number of particles. May be called in callbacks.</summary>
    public long Count { get { return Native.mpm_particles_count(Pointer); } }

    /// <summary>Adds particles: position, velocity and size are [dim][n]. Gives the first id.</summary>
    public long Add(double[] position, double[] volume, double[] velocity = null, double[] size = null, long[] ids = null) {
      long first = 0;
      Fits("position", position.Length, Dim * volume.Length);
      if (velocity != null) Fits("velocity", velocity.Length, Dim * volume.Length);
      if (size != null) Fits("size", size.Length, Dim * volume.Length);
      if (ids != null) Fits("ids", ids.Length, volume.Length);
      Call(p => {
        long id;
        fixed (double* x = position, v = velocity, m = volume, s = size) fixed (long* number = ids) {
          int status = Native.mpm_particles_add(p, volume.Length, x, v, m, s, number, &id);
          first = id;
          return status;
        }
      });
      return first;
    }
    /// <summary>Fills a box with perCell[c] particles along each axis of a cell. Gives how many there are.</summary>
    public long FillBox(double[] lower, double[] upper, int[] perCell) {
      long count = 0;
      Axes(lower.Length, upper.Length, perCell.Length);
      Call(p => {
        long n;
        fixed (double* low = lower, high = upper) fixed (int* per = perCell) {
          int status = Native.mpm_particles_fill_box(p, low, high, per, null, &n);
          count = n;
          return status;
        }
      });
      return count;
    }
    /// <summary>Fills a ball; in 2-D a disc, in 1-D an interval.</summary>
    public long FillBall(double[] centre, double radius, int[] perCell) {
      long count = 0;
      Axes(centre.Length, perCell.Length);
      Call(p => {
        long n;
        fixed (double* at = centre) fixed (int* per = perCell) {
          int status = Native.mpm_particles_fill_ball(p, at, radius, per, null, &n);
          count = n;
          return status;
        }
      });
      return count;
    }
    /// <summary>Fills what a mesh encloses: position is [dim][n], corner [elements][dim] with numbers of points.</summary>
    public long FillMesh(double[] position, long[] corner, int[] perCell) {
      long count = 0;
      int dim = Dim, points = position.Length / dim, elements = corner.Length / dim;
      Axes(perCell.Length);
      Fits("position", position.Length, points * dim);
      Fits("corner", corner.Length, elements * dim);
      Call(p => {
        long n;
        fixed (double* at = position) fixed (long* of = corner) fixed (int* per = perCell) {
          int status = Native.mpm_particles_fill_mesh(p, points, at, elements, of, per, null, &n);
          count = n;
          return status;
        }
      });
      return count;
    }
    /// <summary>Fills that part of a box which a function accepts.</summary>
    public long Fill(double[] lower, double[] upper, int[] perCell, InsideFunction inside) {
      long count = 0;
      Axes(lower.Length, upper.Length, perCell.Length);
      var slot = new Slot(node.Core, inside);
      try {
        Call(p => {
          long n;
          fixed (double* low = lower, high = upper) fixed (int* per = perCell) {
            int status = Native.mpm_particles_fill(p, low, high, per, Trampolines.Inside, slot.User, null, &n);
            count = n;
            return status;
          }
        });
      } finally {
        slot.Free();
      }
      return count;
    }
    /// <summary>Removes particles by id: all or none.</summary>
    public void Remove(long[] ids) {
      Call(p => {
        fixed (long* first = ids) return Native.mpm_particles_remove(p, ids.Length, first);
      });
    }

    /// <summary>Packs the particles with these ids in this order, or all by ascending id, for Unpack of this set or of
    /// another.</summary>
    public byte[] Pack(long[] ids = null) {
      long n = ids == null ? Count : ids.Length;
      byte[] packed = null;
      Call(p => {
        long bytes;
        int status = Native.mpm_particles_packed_size(p, n, &bytes);
        if (status != MPM_OK) return status;
        packed = new byte[bytes];
        fixed (long* id = Chosen(ids)) fixed (byte* to = packed)
          return Native.mpm_particles_pack(p, n, id, (IntPtr)to, bytes);
      });
      return packed;
    }
    /// <summary>Adds particles that Pack has given: all or none.</summary>
    public void Unpack(byte[] packed) {
      Call(p => {
        fixed (byte* from = packed) return Native.mpm_particles_unpack(p, (IntPtr)from, packed.Length);
      });
    }

    /// <summary>Components of copies of a field; 1 for a name that there is not, which the library then refuses.</summary>
    int ComponentsOf(string field) {
      for (int k = 0;; k++) {
        IntPtr name = IntPtr.Zero;
        int components = 0, status = MPM_OK;
        Call(p => {
          IntPtr text;
          int c;
          status = Native.mpm_particles_field_info(p, k, (byte**)&text, null, &c, null);
          name = text;
          components = c;
          return MPM_OK;
        });
        if (status != MPM_OK) return 1;
        if (Text.Of(name) == field) return components;
      }
    }
    /// <summary>Adds a field of the host, zero in every particle.</summary>
    public void AddField<T>(string field, int components) {
      Call(p => {
        fixed (byte* name = Text.Bytes(field)) return Native.mpm_particles_add_field(p, name, FieldView.TypeOf<T>(), components);
      });
    }
    /// <summary>Copies a field, of all particles by ascending id or of some: [components][n], tensors in full.</summary>
    public T[] Get<T>(string field, long[] ids = null) {
      return Copied<T>(Native.mpm_particles_get, field, ComponentsOf(field), Count, ids);
    }
    /// <summary>Copies fields of all particles as floats for renderers, one particle after the other and without inert slots:
    /// [particle][component]. order is MPM_BY_ID, or MPM_LIBRARY_ORDER, which is faster.</summary>
    public float[] GetF32(int order, params string[] fields) {
      int width = 0;
      foreach (string field in fields) width += ComponentsOf(field);
      long n = Count;
      var values = new float[n * width];
      using (var names = new Names(fields))
        Call(p => {
          fixed (IntPtr* first = names.Pointers) fixed (float* to = values)
            return Native.mpm_particles_get_f32(p, fields.Length, (byte**)first, order, n, to);
        });
      return values;
    }
    /// <summary>Sets a field, laid out as in Get.</summary>
    public void Set<T>(string field, T[] values, long[] ids = null) {
      Overwritten(Native.mpm_particles_set, field, values, ComponentsOf(field), Count, ids);
    }
    /// <summary>Sets a field to one value in every particle.</summary>
    public void SetAll<T>(string field, params T[] value) {
      Pinned(value, at => Call(p => {
        fixed (byte* name = Text.Bytes(field))
          return Native.mpm_particles_set_all(p, name, FieldView.TypeOf<T>(), value.Length, at);
      }));
    }
    /// <summary>Lends a field: MPM_READ, MPM_WRITE or both. Steps are refused until the view is disposed of.</summary>
    public FieldView Map(string field, int access = MPM_READ) {
      return new FieldView(this, access, (p, view) => {
        fixed (byte* name = Text.Bytes(field)) return Native.mpm_particles_map(p, name, access, view);
      });
    }
    public void SetGeostatic(int axis, double gravity, double surface, double K0, double surcharge) {
      Call(p => Native.mpm_particles_set_geostatic(p, axis, gravity, surface, K0, surcharge));
    }
    public void ResetReference() {
      Call(Native.mpm_particles_reset_reference);
    }
    /// <summary>Writes a .vtp file with the named fields; with none all that are in use.</summary>
    public void Write(string path, params string[] fields) {
      using (var names = new Names(fields))
        Call(p => {
          fixed (byte* file = Text.Bytes(path)) fixed (IntPtr* first = names.Pointers)
            return Native.mpm_write_particles(p, file, fields.Length, (byte**)first);
        });
    }
    /// <summary>Gives a stream the bytes of that file. What the stream throws comes out.</summary>
    public void WriteTo(Stream stream, params string[] fields) {
      using (var names = new Names(fields))
        Streamed(stream, (p, user) => {
          fixed (IntPtr* first = names.Pointers)
            return Native.mpm_write_particles_to(p, Trampolines.Write, user, fields.Length, (byte**)first);
        });
    }

    void Axes(params int[] lengths) {
      foreach (int length in lengths) Fits("vector", length, Dim);
    }
  }

  /// <summary>Memory of the library, lent until Dispose(): items in library order, with inert slots (id below 0) and stored
  /// components. After that an access throws.</summary>
  public sealed unsafe class FieldView : IDisposable {
    internal delegate int Mapper(IntPtr pointer, View* view);

    readonly Node node;
    readonly View* view;
    readonly bool writable;
    bool disposed;

    internal FieldView(Handle of, int access, Mapper map) {
      var lent = (View*)Marshal.AllocHGlobal(sizeof(View));
      *lent = View.Empty();
      try {
        of.Call(p => map(p, lent));
      } catch {
        Marshal.FreeHGlobal((IntPtr)lent);
        throw;
      }
      view = lent;
      writable = (access & MPM_WRITE) != 0;
      node = new Node(of.node.Core, p => {
        // values that are bad bar the set from steps, which say so
        if (((View*)p)->owner != IntPtr.Zero) Native.mpm_view_release((View*)p);
        Marshal.FreeHGlobal(p);
        return MPM_OK;
      }, of.node);
      node.Pointer = (IntPtr)lent;
    }
    ~FieldView() {
      if (node != null && !disposed) node.Release();
    }
    /// <summary>Gives the memory back; throws MPM_E_ARG if bad values were written. In a callback that is done when its call
    /// is over, and the next step says what is bad.</summary>
    public void Dispose() {
      if (disposed) return;
      if (!node.Core.TryEnter()) {
        disposed = true;
        GC.SuppressFinalize(this);
        node.Release();
        return;
      }
      int status = Native.mpm_view_release(view);
      disposed = true;
      GC.SuppressFinalize(this);
      try {
        node.Core.Finish(status, IntPtr.Zero);
      } finally {
        node.Release();
      }
    }
    /// <summary>The number of items, inert slots included.</summary>
    public long Count { get { return Lent()->count; } }
    /// <summary>The number of stored components.</summary>
    public int Components { get { return Lent()->components; } }
    /// <summary>The struct of C.</summary>
    public View Raw { get { return *Lent(); } }

    /// <summary>A component of an item of a field of doubles.</summary>
    public double this[long item, int component] {
      get {
        long k = Index(item, component, MPM_F64);
        return ((double*)view->data)[k];
      }
      set {
        if (!writable) throw new InvalidOperationException("the view is for reading");
        long k = Index(item, component, MPM_F64);
        ((double*)view->data)[k] = value;
      }
    }
    /// <summary>A component of an item of a field of integers, such as "id".</summary>
    public long Integer(long item, int component) {
      long k = Index(item, component, MPM_I64);
      return ((long*)view->data)[k];
    }
    /// <summary>A component of an item of a field of bytes.</summary>
    public byte Byte(long item, int component) {
      long k = Index(item, component, MPM_U8);
      return ((byte*)view->data)[k];
    }
    /// <summary>Writes into a field of integers of the host.</summary>
    public void SetInteger(long item, int component, long value) {
      if (!writable) throw new InvalidOperationException("the view is for reading");
      long k = Index(item, component, MPM_I64);
      ((long*)view->data)[k] = value;
    }
    /// <summary>Writes into a field of bytes.</summary>
    public void SetByte(long item, int component, byte value) {
      if (!writable) throw new InvalidOperationException("the view is for reading");
      long k = Index(item, component, MPM_U8);
      ((byte*)view->data)[k] = value;
    }
    long Index(long item, int component, int type) {
      var lent = Lent();
      if (lent->type != type) throw new InvalidOperationException("the field holds elements of another type");
      if ((ulong)item >= (ulong)lent->count || (uint)component >= (uint)lent->components) throw new IndexOutOfRangeException();
      return item * lent->item_stride + component * lent->component_stride;
    }
    View* Lent() {
      if (disposed) throw new ObjectDisposedException("FieldView");
      return view;
    }
    internal static int TypeOf<T>() {
      if (typeof(T) == typeof(double)) return MPM_F64;
      if (typeof(T) == typeof(long)) return MPM_I64;
      if (typeof(T) == typeof(byte)) return MPM_U8;
      throw new ArgumentException("fields hold double, long or byte, not " + typeof(T).Name);
    }
  }
}
