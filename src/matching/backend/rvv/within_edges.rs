//! A row's costs, averaged within edges.

use super::columns::Columns;
use crate::matching::backend::portable::sgm::edges::edges_at;
use crate::matching::backend::work::{EdgeWork, PathWork};
use core::arch::asm;

/// Makes the costs of the row of those that stand in their place before: of the pixels two rows below, or of
/// no meaning where that is outside of the image.
#[inline(never)]
pub(super) fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>, columns: Columns) {
    let Columns { stride, vtype } = columns;
    let much = work.penalties.edges[1];
    let of = |volume: &mut [u8]| volume.len() / stride.max(1);
    let width = work.width.min(of(work.costs)).min(of(edges.above)).min(of(edges.below));
    for x in 0..width {
        let [at_next, at_last] = edges_at(&edges.guides, x, much).map(u32::from);
        let [costs, above, below] =
            [&mut *work.costs, &mut *edges.above, &mut *edges.below].map(<[u8]>::as_mut_ptr);
        // SAFETY: column `x` is in all three.
        unsafe {
            asm!(
                "vsetvl zero, {stride}, {vtype}",
                // Averages are rounded up.
                "csrwi vxrm, 0",
                "vle8.v v8, ({above})",
                "vle8.v v16, ({below})",
                "vle8.v v24, ({costs})",
                // What is to be the next row's above.
                "vmv.v.v v0, v16",
                "bnez {at_next}, 2f",
                "vaaddu.vv v0, v16, v8",
                "2:",
                "vse8.v v0, ({above})",
                "vse8.v v24, ({below})",
                "bnez {at_next}, 4f",
                "bnez {at_last}, 3f",
                "vaaddu.vv v16, v16, v24",
                "3:",
                "vaaddu.vv v8, v8, v16",
                "4:",
                "vse8.v v8, ({costs})",
                stride = in(reg) stride, vtype = in(reg) vtype, at_next = in(reg) at_next,
                at_last = in(reg) at_last, costs = in(reg) costs.add(x * stride),
                above = in(reg) above.add(x * stride), below = in(reg) below.add(x * stride),
                out("v0") _, out("v1") _, out("v2") _, out("v3") _, out("v4") _, out("v5") _, out("v6") _,
                out("v7") _, out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _,
                out("v13") _, out("v14") _, out("v15") _, out("v16") _, out("v17") _, out("v18") _,
                out("v19") _, out("v20") _, out("v21") _, out("v22") _, out("v23") _, out("v24") _,
                out("v25") _, out("v26") _, out("v27") _, out("v28") _, out("v29") _, out("v30") _,
                out("v31") _, options(nostack),
            );
        }
    }
}
