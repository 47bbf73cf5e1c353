// What all objects share: one call at a time on a context, lifetimes, exceptions of callbacks, texts.
using System;
using System.Collections.Generic;
using System.IO;
using System.Runtime.ExceptionServices;
using System.Runtime.InteropServices;
using System.Text;
using System.Threading;
using static Mpm.Constants;

namespace Mpm {
  /// <summary>A call was not done: the status of C, and the library's sentence.</summary>
  public class MpmException : Exception {
    /// <summary>One of the status constants: below 0 if the call was refused or failed, above 0 if it was not done.</summary>
    public int Status { get; }
    /// <summary>The name of the status.</summary>
    public string Name { get { return Text.Of((IntPtr)Native.mpm_status_name(Status)); } }
    /// <summary>Whether a smaller step may cure it.</summary>
    public bool WantsSmallerStep { get { return Status >= 1 && Status <= 5; } }

    public MpmException(int status, string text) : base(text) {
      Status = status;
    }

    internal static MpmException Of(int status, IntPtr context) {
      string text = context == IntPtr.Zero ? "" : Text.Of(Native.mpm_last_error(context));
      return new MpmException(status, text != "" ? text : Text.Of(Native.mpm_status_text(status)));
    }
    internal static void Check(int status, IntPtr context) {
      if (status != MPM_OK) throw Of(status, context);
    }
  }

  /// <summary>Texts between C and .NET, which are UTF-8 in C.</summary>
  public static unsafe class Text {
    /// <summary>The text that a pointer of C leads to; "" for NULL.</summary>
    public static string Of(IntPtr text) {
      if (text == IntPtr.Zero) return "";
      int n = 0;
      while (((byte*)text)[n] != 0) n++;
      return Encoding.UTF8.GetString((byte*)text, n);
    }
    /// <summary>The bytes of a text, with the zero that C wants.</summary>
    public static byte[] Bytes(string text) {
      if (text == null) throw new ArgumentNullException("text");
      if (text.IndexOf('\0') >= 0) throw new ArgumentException("a name or path has a zero in it");
      return Encoding.UTF8.GetBytes(text + "\0");
    }
  }

  /// <summary>Names for C, for the time of a call.</summary>
  internal sealed class Names : IDisposable {
    readonly GCHandle[] pins;
    public readonly IntPtr[] Pointers;

    public Names(params string[] names) {
      pins = new GCHandle[names.Length];
      Pointers = new IntPtr[names.Length];
      for (int k = 0; k < names.Length; k++) {
        pins[k] = GCHandle.Alloc(Text.Bytes(names[k]), GCHandleType.Pinned);
        Pointers[k] = pins[k].AddrOfPinnedObject();
      }
    }
    public void Dispose() {
      foreach (var pin in pins)
        if (pin.IsAllocated) pin.Free();
    }
  }

  /// <summary>A context of C, and what was thrown in the call under way on it.</summary>
  internal sealed class Core {
    public IntPtr Pointer;
    const int First = -1000000000;
    readonly List<Exception> thrown = new List<Exception>();
    /// <summary>What the log threw first: the call that told it something goes on.</summary>
    Exception logged;
    readonly Queue<Node> burials = new Queue<Node>();
    /// <summary>What could not be freed yet, as views were out: garbage is collected in any order.</summary>
    readonly List<Node> refused = new List<Node>();
    const int Idle = 0, Calling = 1, Burying = 2;
    int busy;

    /// <summary>Begins a call where none is under way.</summary>
    public bool TryEnter() {
      var wait = new SpinWait();
      for (;;) {
        int before = Interlocked.CompareExchange(ref busy, Calling, Idle);
        if (before == Idle) return true;
        if (before == Calling) return false;
        wait.SpinOnce(); // the collector's thread frees something: that runs nothing of the host
      }
    }
    /// <summary>Begins a call; another thread's, or that of a callback, is refused.</summary>
    public void Enter() {
      if (!TryEnter())
        throw new MpmException(MPM_E_STATE, "another call on the context is under way: this one was made in a callback, or on " +
          "another thread");
    }
    /// <summary>Ends a call, and frees what was waiting for that.</summary>
    public void Leave() {
      Interlocked.Exchange(ref busy, Burying);
      for (;;) {
        for (;;) {
          Node node;
          lock (burials) {
            if (burials.Count == 0) {
              Interlocked.Exchange(ref busy, Idle);
              break;
            }
            node = burials.Dequeue();
          }
          if (!node.Destroy()) {
            refused.Add(node);
            continue;
          }
          // what this one stood in the way of is tried again
          lock (burials) {
            foreach (var other in refused) burials.Enqueue(other);
          }
          refused.Clear();
        }
        lock (burials) {
          if (burials.Count == 0 || Interlocked.CompareExchange(ref busy, Burying, Idle) != Idle) return;
        }
      }
    }
    /// <summary>Frees something: now, or after the call that is under way.</summary>
    public void Bury(Node node) {
      lock (burials) burials.Enqueue(node);
      if (Interlocked.CompareExchange(ref busy, Burying, Idle) == Idle) Leave();
    }

    /// <summary>Keeps an exception of a callback and gives the status that stands for it.</summary>
    public int Keep(Exception exception) {
      lock (thrown) {
        thrown.Add(exception);
        return First - (thrown.Count - 1);
      }
    }
    /// <summary>Keeps an exception of the log, which stops no call.</summary>
    public void KeepLogged(Exception exception) {
      lock (thrown) logged = logged ?? exception;
    }
    /// <summary>What comes of a call that ends: throws what a callback threw, where that stopped it, or the library's own
    /// sentence; else what the log threw. The stepper says which of several exceptions is the cause, whatever the
    /// threads.</summary>
    public unsafe void Finish(int status, IntPtr stepper) {
      Exception cause = null;
      MpmException error = status == MPM_OK ? null : MpmException.Of(status, Pointer);
      lock (thrown) {
        if (status == MPM_E_CALLBACK && thrown.Count > 0) {
          var info = StepInfo.Empty();
          if (stepper != IntPtr.Zero) Native.mpm_stepper_info(stepper, &info);
          long number = info.callback_status <= First ? (long)First - info.callback_status : 0;
          cause = thrown[number < thrown.Count ? (int)number : 0];
        }
        thrown.Clear();
        if (status == MPM_OK) cause = logged;
        logged = null;
      }
      Leave();
      if (cause != null) ExceptionDispatchInfo.Capture(cause).Throw();
      if (error != null) throw error;
    }
  }

  /// <summary>An object of C. It is freed when nothing refers to it any more: neither its own handle, nor what was made with
  /// it. So the order of Dispose does not matter.</summary>
  internal sealed class Node {
    public readonly Core Core;
    public IntPtr Pointer;
    /// <summary>Frees the object; refused while a view is out.</summary>
    public Func<IntPtr, int> Free;
    /// <summary>What it was made with, and what it holds on to.</summary>
    public readonly List<Node> Owners = new List<Node>();
    /// <summary>Functions that C may call while it lives.</summary>
    public readonly Dictionary<string, Slot> Slots = new Dictionary<string, Slot>();
    int references = 1;

    public Node(Core core, Func<IntPtr, int> free, params Node[] owners) {
      Core = core;
      Free = free;
      foreach (var owner in owners) Hold(owner);
    }
    public void Hold(Node owner) {
      owner.Refer();
      Owners.Add(owner);
    }
    public void LetGo(Node owner) {
      if (Owners.Remove(owner)) owner.Release();
    }
    void Refer() {
      Interlocked.Increment(ref references);
    }
    public void Release() {
      if (Interlocked.Decrement(ref references) == 0) Core.Bury(this);
    }
    /// <summary>Within a call: frees the object, then lets go of what it was made with; false if it is refused.</summary>
    public bool Destroy() {
      if (Free(Pointer) != MPM_OK) return false;
      Pointer = IntPtr.Zero;
      foreach (var slot in Slots.Values) slot.Free();
      foreach (var owner in Owners) owner.Release();
      return true;
    }
    /// <summary>Puts a function in the place of another, which C has let go of.</summary>
    public void Put(string name, Slot slot) {
      Slot old;
      if (Slots.TryGetValue(name, out old)) old.Free();
      Slots.Remove(name);
      if (slot != null) Slots.Add(name, slot);
    }
  }

  /// <summary>The base of all objects. Dispose() lets go of the object of C; what was made with it keeps it alive.</summary>
  public abstract class Handle : IDisposable {
    internal readonly Node node;
    int disposed;

    internal Handle(Node node) {
      this.node = node;
    }
    /// <summary>Lets go, if Dispose() was not called.</summary>
    ~Handle() {
      LetGo();
    }
    /// <summary>The handle of C.</summary>
    public IntPtr Pointer {
      get {
        if (disposed != 0) throw new ObjectDisposedException(GetType().Name);
        return node.Pointer;
      }
    }
    public void Dispose() {
      LetGo();
      GC.SuppressFinalize(this);
    }
    void LetGo() {
      if (node != null && Interlocked.Exchange(ref disposed, 1) == 0) node.Release();
    }

    /// <summary>Makes a call of C on the object, and throws where it was not done.</summary>
    internal void Call(Func<IntPtr, int> call, bool steps = false) {
      IntPtr pointer;
      node.Core.Enter();
      int status;
      try {
        pointer = Pointer; // which nobody frees now
        status = call(pointer);
      } catch {
        node.Core.Leave();
        throw;
      }
      node.Core.Finish(status, steps ? pointer : IntPtr.Zero);
      GC.KeepAlive(this);
    }
    /// <summary>Lends an array of double, long or byte to a call of C.</summary>
    internal static void Pinned<T>(T[] values, Action<IntPtr> use) {
      FieldView.TypeOf<T>();
      var pin = GCHandle.Alloc(values, GCHandleType.Pinned);
      try {
        use(pin.AddrOfPinnedObject());
      } finally {
        pin.Free();
      }
    }
    /// <summary>Ids for C, for which none of them is not NULL: that stands for all.</summary>
    internal static long[] Chosen(long[] ids) {
      return ids != null && ids.Length == 0 ? new long[1] : ids;
    }
    internal static void Fits(string what, long length, long should) {
      if (length != should) throw new ArgumentException(string.Format("\"{0}\" has {1} values, not {2}", what, length, should));
    }
    /// <summary>mpm_X_get and mpm_X_set of handles whose items have fields.</summary>
    internal unsafe delegate int FieldCall(IntPtr handle, byte* field, int type, int components, long n, long* ids,
        IntPtr values);
    internal unsafe void Exchange<T>(FieldCall call, string field, T[] values, int components, long n, long[] ids) {
      Pinned(values, at => Call(p => {
        fixed (byte* name = Text.Bytes(field)) fixed (long* number = Chosen(ids))
          return call(p, name, FieldView.TypeOf<T>(), components, n, number, at);
      }));
    }
    /// <summary>Copies a field, of all `count` items or of those with the given ids.</summary>
    internal T[] Copied<T>(FieldCall call, string field, int components, long count, long[] ids) {
      long n = ids != null ? ids.Length : count;
      var values = new T[components * n];
      Exchange(call, field, values, components, n, ids);
      return values;
    }
    /// <summary>Sets a field in the same way.</summary>
    internal void Overwritten<T>(FieldCall call, string field, T[] values, int components, long count, long[] ids) {
      long n = ids != null ? ids.Length : count;
      Fits(field, values.Length, components * n);
      Exchange(call, field, values, components, n, ids);
    }
    /// <summary>Gives a stream the bytes of a call of C that takes a function for them.</summary>
    internal void Streamed(Stream stream, Func<IntPtr, IntPtr, int> call) {
      if (stream == null) throw new ArgumentNullException("stream");
      var slot = new Slot(node.Core, new Action<byte[]>(piece => stream.Write(piece, 0, piece.Length)));
      try {
        Call(p => call(p, slot.User));
      } finally {
        slot.Free();
      }
    }
    internal unsafe delegate int Maker(IntPtr* made);

    /// <summary>Makes an object of C by a call.</summary>
    internal static unsafe Node Make(Node node, Maker make) {
      IntPtr pointer = IntPtr.Zero;
      int status;
      try {
        node.Core.Enter();
        try {
          status = make(&pointer);
        } catch {
          node.Core.Leave();
          throw;
        }
        node.Pointer = pointer;
        node.Core.Finish(status, IntPtr.Zero);
      } catch {
        if (node.Pointer == IntPtr.Zero) node.Free = p => MPM_OK;
        node.Release();
        throw;
      }
      return node;
    }
  }
}
