//! Memory as a program in C has it: each piece ends where it is said to, so that the address sanitizer sees
//! what is read or written beyond.

use super::Status;
use arbitrary::{Result, Unstructured};
use std::alloc::{Layout, alloc, dealloc};
use std::ffi::c_void;
use std::ptr::null_mut;

/// The alignment of all pieces.
const ALIGN: usize = 16;
/// How many objects a program has at most.
const MOST_OBJECTS: usize = 6;

/// A piece of memory, and what it held before the call.
struct Piece {
    at: *mut u8,
    length: usize,
    before: Vec<u8>,
    /// The bytes from its first on that the call is told of: behind them may be the place of a handle.
    told: usize,
    /// A refusal may set it to zero: the place of a handle.
    may_be_cleared: bool,
    /// A refusal may have written it: what a call works in.
    may_change: bool,
}

impl Piece {
    fn new(content: Vec<u8>) -> Self {
        let length = content.len();
        // SAFETY: the layout is not empty; the content is as long as what is copied.
        let at = unsafe {
            let at = alloc(Self::layout(length));
            assert!(!at.is_null(), "memory");
            std::ptr::copy_nonoverlapping(content.as_ptr(), at, length);
            at
        };
        Self { at, length, before: content, told: length, may_be_cleared: false, may_change: false }
    }

    fn layout(length: usize) -> Layout {
        Layout::from_size_align(length.max(1), ALIGN).expect("a small piece")
    }

    fn bytes(&self) -> Vec<u8> {
        // SAFETY: the piece has these bytes, all of which were written.
        unsafe { std::slice::from_raw_parts(self.at, self.length) }.to_vec()
    }

    /// A place in it where so many bytes begin, aligned.
    fn inside(&self, u: &mut Unstructured<'_>, bytes: usize, align: usize) -> Result<Option<*mut u8>> {
        let Some(most) = self.length.checked_sub(bytes) else { return Ok(None) };
        // SAFETY: the bytes from there on are in the piece.
        Ok(Some(unsafe { self.at.add(u.int_in_range(0..=most)? / align * align) }))
    }
}

impl Drop for Piece {
    fn drop(&mut self) {
        // SAFETY: it was allocated with this layout.
        unsafe { dealloc(self.at, Self::layout(self.length)) };
    }
}

/// The memory of objects, and the arguments of a call.
pub struct Arena {
    objects: Vec<Piece>,
    arguments: Vec<Piece>,
    /// The object that the call is for.
    called: Option<usize>,
}

impl Arena {
    pub fn new() -> Self {
        Self { objects: Vec::new(), arguments: Vec::new(), called: None }
    }

    /// Forgets the arguments of the last call, and notes what objects are before this one.
    pub fn begin_call(&mut self) {
        self.arguments.clear();
        self.called = None;
        for object in &mut self.objects {
            object.before = if cfg!(miri) { Vec::new() } else { object.bytes() };
            object.told = object.length;
        }
    }

    /// A refusal has changed nothing. Miri knows bytes between fields, which nothing may look at.
    #[track_caller]
    pub fn end_call(&self, status: Status) {
        if cfg!(miri) || status as i32 >= 0 {
            return;
        }
        for (number, piece) in self.objects.iter().chain(&self.arguments).enumerate() {
            let is_cleared = piece.may_be_cleared && piece.bytes().iter().all(|&byte| byte == 0);
            let told = piece.bytes().into_iter().take(piece.told);
            let changed = told.zip(&piece.before).position(|(now, &before)| now != before);
            if let Some(at) = changed.filter(|_| !is_cleared && !piece.may_change) {
                let objects = self.objects.len();
                panic!("{status:?} has changed byte {at} of {number}, of {objects} objects and arguments");
            }
        }
    }

    /// Memory for an object that takes so many bytes: enough, too short, misaligned, used already, none.
    pub fn memory(&mut self, u: &mut Unstructured<'_>, needed: usize) -> Result<(*mut c_void, usize)> {
        let length = match u.int_in_range(0..=7)? {
            0 => u.int_in_range(0..=needed)?,
            1 => needed.saturating_sub(1),
            2 => needed + u.int_in_range(0..=100)?,
            _ => needed,
        };
        let kind = u.int_in_range(0..=15)?;
        if kind == 0 {
            return Ok((null_mut(), length));
        }
        let is_used = kind < 6 || self.objects.len() == MOST_OBJECTS;
        if is_used && let Some(last) = self.objects.len().checked_sub(1) {
            let object = u.int_in_range(0..=last)?;
            self.called = Some(object);
            let piece = &mut self.objects[object];
            piece.told = length.min(piece.length);
            return Ok((piece.at.cast(), piece.told));
        }
        let offset = if kind == 6 { u.int_in_range(0..=7)? } else { 0 };
        self.objects.push(Piece::new(vec![if u.arbitrary()? { 0xA5 } else { 0 }; offset + length]));
        self.called = Some(self.objects.len() - 1);
        // SAFETY: the piece is longer than the offset.
        Ok((unsafe { self.objects[self.objects.len() - 1].at.add(offset) }.cast(), length))
    }

    /// A handle: of any object of any kind, alive or not, or what is none.
    pub fn handle<T>(&mut self, u: &mut Unstructured<'_>) -> Result<*mut T> {
        let Some(last) = self.objects.len().checked_sub(1) else { return Ok(null_mut()) };
        match u.int_in_range(0..=31)? {
            0 => Ok(null_mut()),
            // SAFETY: no more than an address; what is misaligned is not looked at.
            1 => Ok(self.objects[last].at.wrapping_add(u.int_in_range(1..=7)?).cast()),
            kind => {
                // The newest one most often.
                let object = if kind < 8 { u.int_in_range(0..=last)? } else { last };
                self.called = Some(object);
                // A handle is memory of eight bytes at least.
                let Piece { at, length, .. } = self.objects[object];
                Ok(if length < size_of::<u64>() { null_mut() } else { at.cast() })
            }
        }
    }

    /// A pointer to an array: right, null, misaligned, into the object's memory, or where another one is.
    pub fn array<T>(&mut self, u: &mut Unstructured<'_>, count: usize) -> Result<*mut T> {
        let length = u.int_in_range(1..=16)?;
        let some = u.bytes(length.min(u.len()))?.to_vec();
        self.with(u, count, some)
    }

    /// A pointer to these values, or another one as [`Self::array`] has it.
    pub fn values<T: Copy>(&mut self, u: &mut Unstructured<'_>, values: &[T]) -> Result<*mut T> {
        // SAFETY: the values' bytes; those between fields are copied, not looked at.
        let bytes = unsafe { std::slice::from_raw_parts(values.as_ptr().cast(), size_of_val(values)) };
        self.with(u, values.len(), bytes.to_vec())
    }

    fn with<T>(&mut self, u: &mut Unstructured<'_>, count: usize, some: Vec<u8>) -> Result<*mut T> {
        let (bytes, align) = (count * size_of::<T>(), align_of::<T>());
        match u.int_in_range(0..=31)? {
            0 => return Ok(null_mut()),
            1 => {
                self.arguments.push(Piece::new(vec![7; bytes + 1]));
                let piece = &self.arguments[self.arguments.len() - 1];
                // SAFETY: the piece is a byte longer than the array.
                return Ok(unsafe { piece.at.add(1) }.cast());
            }
            2 if let Some(object) = self.called => {
                if let Some(at) = self.objects[object].inside(u, bytes, align)? {
                    return Ok(at.cast());
                }
            }
            3 if let Some(piece) = self.arguments.last() => {
                if let Some(at) = piece.inside(u, bytes, align)? {
                    return Ok(at.cast());
                }
            }
            _ => {}
        }
        let content = some.iter().chain(&[0]).copied().cycle().take(bytes);
        let content = if some.len() == bytes { some.clone() } else { content.collect() };
        self.arguments.push(Piece::new(content));
        Ok(self.arguments[self.arguments.len() - 1].at.cast())
    }

    /// A pointer to an array that the call works in, apart from all others, or null.
    pub fn scratch<T>(&mut self, u: &mut Unstructured<'_>, count: usize) -> Result<*mut T> {
        if u.ratio(1, 32)? {
            return Ok(null_mut());
        }
        let content = vec![u.arbitrary()?; count * size_of::<T>()];
        let mut piece = Piece::new(content);
        piece.may_change = true;
        self.arguments.push(piece);
        Ok(self.arguments[self.arguments.len() - 1].at.cast())
    }

    /// A place for a handle.
    pub fn cell<T>(&mut self, u: &mut Unstructured<'_>) -> Result<*mut *mut T> {
        let cell = self.array::<*mut T>(u, 1)?;
        if let Some(piece) = self.arguments.last_mut() {
            piece.may_be_cleared = true;
        }
        Ok(cell)
    }
}
