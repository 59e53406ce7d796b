//! NumPy's array files (NEP 1): versions 1 to 3, two-dimensional, little-endian floats, rows first.

/// Columns, and all numbers row by row. An error says what was expected and found.
pub(super) fn read(bytes: &[u8]) -> Result<(usize, Vec<f32>), String> {
    let not_npy = || "no NPY file: expected it to begin with \\x93NUMPY, a version and a header".to_owned();
    let rest = bytes.strip_prefix(b"\x93NUMPY").ok_or_else(not_npy)?;
    let (version, rest) = rest.split_first_chunk::<2>().ok_or_else(not_npy)?;
    let (length, rest) = match version[0] {
        1 => rest.split_first_chunk::<2>().map(|(length, rest)| (usize::from(u16::from_le_bytes(*length)), rest)),
        _ => rest.split_first_chunk::<4>().map(|(length, rest)| (u32::from_le_bytes(*length) as usize, rest)),
    }
    .ok_or_else(not_npy)?;
    let (header, data) = rest.split_at_checked(length).ok_or_else(not_npy)?;
    let header = String::from_utf8_lossy(header);
    if value(&header, "fortran_order").is_none_or(|order| !order.starts_with("False")) {
        return Err("the array lies column by column: save numpy.ascontiguousarray(array)".to_owned());
    }
    let (rows, columns) = shape(&header).ok_or_else(|| {
        let found: String = header.chars().take(100).collect();
        format!("expected an array of images x dimensions, found {found}")
    })?;
    let count = rows.checked_mul(columns).ok_or_else(not_npy)?;
    let numbers: Vec<f32> = match value(&header, "descr").map(|kind| kind.trim_matches(['\'', '"'])) {
        Some(kind) if kind.starts_with("<f4") => {
            data.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
        }
        Some(kind) if kind.starts_with("<f8") => {
            data.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes) as f32).collect()
        }
        kind => {
            let found = kind.and_then(|kind| kind.split(['\'', '"']).next()).unwrap_or("none");
            return Err(format!("numbers of type {found}: expected <f4; save array.astype('<f4')"));
        }
    };
    if numbers.len() == count {
        Ok((columns, numbers))
    } else {
        Err(format!("{} numbers for a shape of {rows} x {columns}: the file is cut off or damaged", numbers.len()))
    }
}

/// What stands behind a key of the header, a Python dictionary.
fn value<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let (_, behind) = header.split_once(&format!("'{key}'"))?;
    Some(behind.trim_start().strip_prefix(':')?.trim_start())
}

fn shape(header: &str) -> Option<(usize, usize)> {
    let (inside, _) = value(header, "shape")?.strip_prefix('(')?.split_once(')')?;
    let (rows, columns) = inside.split_once(',')?;
    Some((rows.trim().parse().ok()?, columns.trim().parse().ok()?))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A file as `numpy.save` writes it.
    pub(crate) fn file(kind: &str, shape: &str, numbers: &[f32]) -> Vec<u8> {
        let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        while (10 + header.len() + 1) % 64 != 0 {
            header.push(' ');
        }
        header.push('\n');
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        match kind {
            "<f8" => bytes.extend(numbers.iter().flat_map(|number| f64::from(*number).to_le_bytes())),
            _ => bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes())),
        }
        bytes
    }

    #[test]
    fn arrays_are_read_and_others_refused() {
        let numbers = [1.0, -2.5, 3.25, 4.0, 5.0, 6.0];
        assert_eq!(read(&file("<f4", "(2, 3)", &numbers)), Ok((3, numbers.to_vec())));
        assert_eq!(read(&file("<f8", "(3, 2)", &numbers)), Ok((2, numbers.to_vec())));
        let refused = |bytes: &[u8], word: &str| {
            let error = read(bytes).unwrap_err();
            assert!(error.contains(word), "expected '{word}' in: {error}");
        };
        refused(b"PK", "NUMPY");
        refused(&file("<i4", "(2, 3)", &numbers), "<i4");
        refused(&file("<f4", "(6,)", &numbers), "images x dimensions");
        refused(&file("<f4", "(7, 3)", &numbers), "cut off");
        let fortran = file("<f4", "(2, 3)", &numbers);
        let text = String::from_utf8_lossy(&fortran[10..100]).find("False").unwrap() + 10;
        let mut fortran = fortran;
        fortran[text..text + 5].copy_from_slice(b"True ");
        refused(&fortran, "ascontiguousarray");
    }
}
