//! The linear system of an implicit step, for hosts that solve it themselves.
use crate::{sys, Error, Result};

/// A linear system `matrix * solution = rhs`, during the call of the host's solver.
pub struct LinearSystem<'a> {
    matrix: *const sys::mpm_operator,
    info: sys::mpm_operator_info,
    /// The wanted `||matrix * solution - rhs|| / ||rhs||`.
    pub tolerance: f64,
    /// The right-hand side.
    pub rhs: &'a [f64],
    /// The solution, preset to the best guess known.
    pub solution: &'a mut [f64],
}

/// The matrix by compressed rows, with both triangles and with columns in ascending order.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// `[rows + 1]`: row r has the entries from `start[r]` to `start[r + 1] - 1`.
    pub start: &'a [i64],
    /// `[nonzeros]`.
    pub column: &'a [i32],
    /// `[nonzeros]`.
    pub value: &'a [f64],
}

impl<'a> LinearSystem<'a> {
    /// # Safety
    /// The arguments are those of the solver's call under way.
    pub(crate) unsafe fn new(
        matrix: *const sys::mpm_operator,
        rhs: *const f64,
        solution: *mut f64,
        tolerance: f64,
    ) -> Result<Self> {
        let mut info = sys::mpm_operator_info::default();
        check(sys::mpm_operator_get_info(matrix, &mut info))?;
        let rows = info.rows as usize;
        Ok(LinearSystem {
            matrix,
            info,
            tolerance,
            rhs: std::slice::from_raw_parts(rhs, rows),
            solution: std::slice::from_raw_parts_mut(solution, rows),
        })
    }
    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.info.rows as usize
    }
    /// Whether the matrix is symmetric.
    pub fn symmetric(&self) -> bool {
        self.info.symmetric != 0
    }
    /// Whether it is expected to be positive definite.
    pub fn positive_definite(&self) -> bool {
        self.info.positive_definite != 0
    }
    /// A number that stays the same as long as the sparsity does.
    pub fn pattern_id(&self) -> i64 {
        self.info.pattern_id
    }
    /// Node of each row.
    pub fn node(&self) -> &'a [i64] {
        // SAFETY: valid until the solver returns.
        unsafe { std::slice::from_raw_parts(self.info.node, self.rows()) }
    }
    /// Axis of each row.
    pub fn component(&self) -> &'a [i32] {
        // SAFETY: valid until the solver returns.
        unsafe { std::slice::from_raw_parts(self.info.component, self.rows()) }
    }
    /// The struct of C, for positions.
    pub fn raw(&self) -> &sys::mpm_operator_info {
        &self.info
    }
    /// Computes `y = matrix * x`.
    pub fn apply(&self, x: &[f64], y: &mut [f64]) -> Result<()> {
        crate::arrays::fits("x", x.len(), self.rows())?;
        crate::arrays::fits("y", y.len(), self.rows())?;
        // SAFETY: both have the rows of the system and do not overlap.
        check(unsafe { sys::mpm_operator_apply(self.matrix, x.as_ptr(), y.as_mut_ptr()) })
    }
    /// The matrix by rows.
    pub fn csr(&self) -> Result<Rows<'a>> {
        let (mut start, mut column, mut value) = (std::ptr::null(), std::ptr::null(), std::ptr::null());
        // SAFETY: the arrays are valid until the solver returns.
        unsafe {
            check(sys::mpm_operator_csr(self.matrix, &mut start, &mut column, &mut value))?;
            let nonzeros = self.info.nonzeros as usize;
            Ok(Rows {
                start: std::slice::from_raw_parts(start, self.rows() + 1),
                column: std::slice::from_raw_parts(column, nonzeros),
                value: std::slice::from_raw_parts(value, nonzeros),
            })
        }
    }
}

fn check(status: i32) -> Result<()> {
    if status == sys::MPM_OK {
        return Ok(());
    }
    Err(Error::new(status, ""))
}
