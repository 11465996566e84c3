//! Reads accessors of glTF: lists of numbers in buffers.
//!
//! The `gltf` crate has readers too, but they trust offsets, counts and strides, and panic where these are wrong. Here,
//! everything is checked before a byte is read or memory is taken.

use gltf::json::accessor::{ComponentType, Type, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Index, Root, buffer};

use crate::draft::Context;
use crate::error::{Error, Kind, Place};

/// The bytes of all buffers.
pub(super) struct Buffers(pub Vec<Vec<u8>>);

/// Numbers in a buffer, at equal distances.
struct Run<'a> {
    bytes: &'a [u8],
    stride: usize,
    kind: ComponentType,
    width: usize,
}

impl Run<'_> {
    /// The numbers of element `k`.
    fn element(&self, k: usize) -> impl Iterator<Item = &[u8]> {
        let size = self.kind.size();
        self.bytes[k * self.stride..].chunks_exact(size).take(self.width)
    }
}

/// Numbers as they lie in a file.
pub(super) struct Numbers {
    /// All numbers, `width` per element.
    pub values: Vec<f64>,
    pub width: usize,
    pub count: usize,
    pub kind: ComponentType,
}

pub(super) fn place(path: &str, index: usize) -> Place {
    Place::Json(format!("{path}[{index}]"))
}

impl Buffers {
    /// Returns the bytes of a view.
    pub fn view(&self, json: &Root, view: Index<buffer::View>, context: &Context) -> Result<&[u8], Error> {
        let at = || place("bufferViews", view.value());
        let fail = |message: String| context.error(at(), Kind::Index, message);
        let part = json.buffer_views.get(view.value()).ok_or_else(|| fail("no such view".to_owned()))?;
        let bytes = self.0.get(part.buffer.value()).map_or(&[][..], |bytes| &bytes[..]);
        let start = part.byte_offset.unwrap_or_default().0;
        let end = start.checked_add(part.byte_length.0).filter(|end| *end <= bytes.len() as u64);
        let end = end.ok_or_else(|| {
            let (length, found) = (part.byte_length.0, bytes.len());
            fail(format!("bytes {start} to {start} + {length} of a buffer that has {found}; export the file again"))
        })?;
        Ok(&bytes[start as usize..end as usize])
    }

    /// The elements of a view, once it is sure that all of them are in it.
    fn run(
        &self,
        json: &Root,
        view: Index<buffer::View>,
        offset: u64,
        (count, width, kind): (usize, usize, ComponentType),
        context: &Context,
    ) -> Result<Run<'_>, Error> {
        let bytes = self.view(json, view, context)?;
        let size = kind.size() * width;
        let stride = json.buffer_views[view.value()].byte_stride.map_or(size, |stride| stride.0);
        let needed = (count as u64)
            .checked_sub(1)
            .map_or(Some(0), |more| more.checked_mul(stride as u64)?.checked_add(size as u64)?.checked_add(offset));
        if stride < size || needed.is_none_or(|needed| needed > bytes.len() as u64) {
            let message = format!(
                "{count} elements of {size} bytes, {stride} apart, from byte {offset} on, in a view of {} bytes; \
                 export the file again",
                bytes.len()
            );
            return Err(context.error(place("bufferViews", view.value()), Kind::Index, message));
        }
        Ok(Run { bytes: bytes.get(offset as usize..).unwrap_or_default(), stride, kind, width })
    }

    /// Returns the numbers of an accessor, if it is of one of the types.
    pub fn numbers(&self, json: &Root, index: usize, types: &[Type], context: &mut Context) -> Result<Numbers, Error> {
        let at = || place("accessors", index);
        let accessor = json.accessors.get(index).ok_or_else(|| context.error(at(), Kind::Index, "no such accessor"))?;
        let (Checked::Valid(kind), Checked::Valid(type_)) = (accessor.component_type, accessor.type_) else {
            return Err(context.error(at(), Kind::Syntax, "its type is unknown"));
        };
        let kind = kind.0;
        if !types.contains(&type_) {
            return Err(context.error(at(), Kind::Syntax, format!("type {type_:?}, where {types:?} is needed")));
        }
        let width = type_.multiplicity();
        context.take_numbers(accessor.count.0.saturating_mul(width as u64), at)?;
        let count = accessor.count.0 as usize;
        let mut values = Vec::with_capacity(count * width);
        let normalized = accessor.normalized;
        match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                let run = self.run(json, view, offset, (count, width, kind), context)?;
                values.extend((0..count).flat_map(|k| run.element(k)).map(|bytes| number(bytes, kind, normalized)));
            }
            None => values.resize(count * width, 0.0),
        }
        if let Some(sparse) = &accessor.sparse {
            self.apply(json, sparse, (&mut values, width, kind, normalized), index, context)?;
        }
        if let Some(k) = values.iter().position(|x| !x.is_finite()) {
            let message = format!("element {} is not finite; export the file again", k / width);
            return Err(context.error(at(), Kind::NonFinite, message));
        }
        Ok(Numbers { values, width, count, kind })
    }

    /// Replaces the elements that a sparse accessor names.
    fn apply(
        &self,
        json: &Root,
        sparse: &Sparse,
        (values, width, kind, normalized): (&mut [f64], usize, ComponentType, bool),
        index: usize,
        context: &mut Context,
    ) -> Result<(), Error> {
        let at = || Place::Json(format!("accessors[{index}].sparse"));
        context.take_numbers(sparse.count.0.saturating_mul(width as u64 + 1), at)?;
        let count = sparse.count.0 as usize;
        let Checked::Valid(index_kind) = sparse.indices.component_type else {
            return Err(context.error(at(), Kind::Syntax, "the type of its indices is unknown"));
        };
        let index_kind = index_kind.0;
        let (indices, new) = (&sparse.indices, &sparse.values);
        let numbers = self.run(json, indices.buffer_view, indices.byte_offset.0, (count, 1, index_kind), context)?;
        let new = self.run(json, new.buffer_view, new.byte_offset.0, (count, width, kind), context)?;
        for k in 0..count {
            let element = numbers.element(k).next().map_or(0, |bytes| number(bytes, index_kind, false) as usize);
            let Some(into) = values.chunks_exact_mut(width).nth(element) else {
                let message = format!("index {element}, where the accessor has {} elements", values.len() / width);
                return Err(context.error(at(), Kind::Index, message));
            };
            into.iter_mut().zip(new.element(k)).for_each(|(value, bytes)| *value = number(bytes, kind, normalized));
        }
        Ok(())
    }
}

/// One number. Normalized integers are parts of 1.
fn number(bytes: &[u8], kind: ComponentType, normalized: bool) -> f64 {
    let four = || bytes.first_chunk::<4>().copied().unwrap_or_default();
    let two = || bytes.first_chunk::<2>().copied().unwrap_or_default();
    let (value, most) = match kind {
        ComponentType::I8 => (f64::from(bytes[0] as i8), 127.0),
        ComponentType::U8 => (f64::from(bytes[0]), 255.0),
        ComponentType::I16 => (f64::from(i16::from_le_bytes(two())), 32_767.0),
        ComponentType::U16 => (f64::from(u16::from_le_bytes(two())), 65_535.0),
        ComponentType::U32 => (f64::from(u32::from_le_bytes(four())), f64::from(u32::MAX)),
        ComponentType::F32 => return f64::from(f32::from_le_bytes(four())),
    };
    if normalized { (value / most).max(-1.0) } else { value }
}

impl Numbers {
    /// Returns elements of `N` numbers. The accessor was asked for types of that width.
    pub fn arrays<const N: usize>(&self) -> Vec<[f32; N]> {
        let elements = self.values.chunks_exact(self.width);
        elements.map(|element| std::array::from_fn(|k| element.get(k).map_or(0.0, |x| *x as f32))).collect()
    }

    /// Returns all numbers as 32-bit floats.
    pub fn floats(&self) -> Vec<f32> {
        self.values.iter().map(|x| *x as f32).collect()
    }
}
