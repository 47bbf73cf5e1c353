//! Views of the library's memory.
use crate::entry::{Core, Sent};
use crate::{sys, Error, Result};
use std::marker::PhantomData;
use std::ops::{Deref, Index, IndexMut};
use std::sync::Arc;

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for i64 {}
    impl Sealed for u8 {}
}

/// A type of fields: `f64`, `i64` or `u8`.
pub trait Element: sealed::Sealed + Copy + Default + Send + Sync + 'static {
    /// The constant of C.
    const TYPE: i32;
}
impl Element for f64 {
    const TYPE: i32 = sys::MPM_F64;
}
impl Element for i64 {
    const TYPE: i32 = sys::MPM_I64;
}
impl Element for u8 {
    const TYPE: i32 = sys::MPM_U8;
}

/// A field in the library's memory, for reading: items in library order, with inert slots (`id < 0`) and the stored
/// components. It borrows what it looks into.
pub struct View<'a, T: Element> {
    lent: Lent,
    what: PhantomData<&'a [T]>,
}

/// The same for reading and writing: a [`View`] and more. What was written takes effect when the view goes;
/// [`ViewMut::release`] tells whether it was good.
pub struct ViewMut<'a, T: Element> {
    shown: View<'a, T>,
    what: PhantomData<&'a mut [T]>,
}

/// What was lent, which Drop gives back.
pub(crate) struct Lent {
    context: Arc<Core>,
    view: sys::mpm_view,
}

// SAFETY: memory that is lent may be used on any thread, and an Entry gives it back.
unsafe impl Send for Lent {}
unsafe impl Sync for Lent {}

impl Lent {
    /// Maps by a call of C, and sees that the field holds what is asked for.
    pub fn new<T: Element>(
        context: &Arc<Core>,
        field: &str,
        access: i32,
        map: impl FnOnce(i32, *mut sys::mpm_view) -> i32,
    ) -> Result<Self> {
        let mut view = sys::mpm_view::default();
        let entry = context.enter()?;
        let status = map(access, &mut view);
        entry.done(status)?;
        let lent = Lent { context: context.clone(), view };
        if lent.view.r#type != T::TYPE {
            let names = ["", "f64", "i64", "u8"];
            let (holds, asked) = (names[lent.view.r#type as usize], names[T::TYPE as usize]);
            return Err(Error::argument(format!("\"{field}\" holds {holds}, not {asked}")));
        }
        if lent.view.item_stride != 1 {
            return Err(Error::new(sys::MPM_E_UNSUPPORTED, "items that are not side by side are for mpm::sys"));
        }
        Ok(lent)
    }

    fn column<T>(&self, component: usize) -> *mut T {
        assert!(component < self.view.components as usize, "there are {} components", self.view.components);
        // SAFETY: the component is in range.
        unsafe { self.view.data.cast::<T>().offset(component as isize * self.view.component_stride as isize) }
    }

    fn release(mut self) -> Result<()> {
        let entry = self.context.enter()?;
        // SAFETY: it is lent until now.
        let status = unsafe { sys::mpm_view_release(&mut self.view) };
        entry.done(status)
    }
}

impl Drop for Lent {
    fn drop(&mut self) {
        if self.view.owner.is_null() {
            return;
        }
        let view = Sent(Box::into_raw(Box::new(self.view)));
        self.context.bury(move || {
            // SAFETY: it is lent until now. Bad values bar the set from steps, which say so.
            unsafe {
                sys::mpm_view_release(view.get());
                drop(Box::from_raw(view.get()));
            }
        });
    }
}

impl<'a, T: Element> View<'a, T> {
    pub(crate) fn of(lent: Lent) -> Self {
        View { lent, what: PhantomData }
    }
    /// The number of items, inert slots included.
    pub fn len(&self) -> usize {
        self.lent.view.count as usize
    }
    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// The number of stored components.
    pub fn components(&self) -> usize {
        self.lent.view.components as usize
    }
    /// A component of all items.
    pub fn column(&self, component: usize) -> &[T] {
        if self.is_empty() {
            return &[];
        }
        // SAFETY: items are side by side, and are not written while the view borrows their owner.
        unsafe { std::slice::from_raw_parts(self.lent.column(component), self.len()) }
    }
    /// Gives the memory back, as Drop does, and tells whether all was well.
    pub fn release(self) -> Result<()> {
        self.lent.release()
    }
}

impl<T: Element> Index<(usize, usize)> for View<'_, T> {
    type Output = T;
    /// Of an item a component.
    fn index(&self, (item, component): (usize, usize)) -> &T {
        &self.column(component)[item]
    }
}

impl<'a, T: Element> ViewMut<'a, T> {
    pub(crate) fn of(lent: Lent) -> Self {
        ViewMut { shown: View::of(lent), what: PhantomData }
    }
    /// A component of all items, to be written.
    pub fn column_mut(&mut self, component: usize) -> &mut [T] {
        if self.is_empty() {
            return &mut [];
        }
        // SAFETY: items are side by side, and the view alone has them.
        unsafe { std::slice::from_raw_parts_mut(self.shown.lent.column(component), self.len()) }
    }
    /// Gives the memory back; `MPM_E_ARG` if bad values were written, until whose repair the set does not step.
    pub fn release(self) -> Result<()> {
        self.shown.release()
    }
}

impl<'a, T: Element> Deref for ViewMut<'a, T> {
    type Target = View<'a, T>;
    fn deref(&self) -> &View<'a, T> {
        &self.shown
    }
}

impl<T: Element> Index<(usize, usize)> for ViewMut<'_, T> {
    type Output = T;
    /// Of an item a component.
    fn index(&self, at: (usize, usize)) -> &T {
        &self.shown[at]
    }
}

impl<T: Element> IndexMut<(usize, usize)> for ViewMut<'_, T> {
    /// Of an item a component.
    fn index_mut(&mut self, (item, component): (usize, usize)) -> &mut T {
        &mut self.column_mut(component)[item]
    }
}
