//! From the bytes of each format to the surface, whole and damaged.

use super::*;

/// A small tube in every format, each byte string with its format.
fn files() -> Vec<(Format, Vec<u8>)> {
    let raw = grid(5, 3, true);
    let (mut obj, mut text) = (String::new(), String::from("solid\n"));
    let head = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n\
         property double z\nelement face {}\nproperty list uchar int vertex_index\nend_header\n",
        raw.points.len(),
        raw.polygons.len()
    );
    let mut ply = head.clone();
    let mut binary_ply = head.replace("ascii", "binary_little_endian").into_bytes();
    let mut stl = vec![b' '; 80];
    stl.extend(u32::try_from(raw.polygons.len()).unwrap().to_le_bytes());
    for p in &raw.points {
        obj += &format!("v {:.3} {:.3} {:.3}\n", p.x, p.y, p.z);
        ply += &format!("{:.3} {:.3} {:.3}\n", p.x, p.y, p.z);
        binary_ply.extend(p.to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    for t in &raw.polygons {
        obj += &format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
        ply += &format!("3 {} {} {}\n", t[0], t[1], t[2]);
        binary_ply.push(3);
        binary_ply.extend(t.iter().flat_map(|&i| i32::try_from(i).unwrap().to_le_bytes()));
        text += "facet normal 0 0 1\nouter loop\n";
        stl.extend([0u8; 12]);
        for p in t.iter().map(|&v| raw.points[v]) {
            text += &format!("vertex {:.3} {:.3} {:.3}\n", p.x, p.y, p.z);
            stl.extend(p.to_array().iter().flat_map(|&x| (x as f32).to_le_bytes()));
        }
        text += "endloop\nendfacet\n";
        stl.extend([0u8; 2]);
    }
    text += "endsolid\n";
    vec![
        (Format::Obj, obj.into_bytes()),
        (Format::Ply, ply.into_bytes()),
        (Format::Ply, binary_ply),
        (Format::Stl, text.into_bytes()),
        (Format::Stl, stl),
    ]
}

#[test]
fn every_format_gives_the_same_tube() {
    for (format, bytes) in files() {
        let valid = validate(&read(&bytes, format).unwrap(), &OPTIONS).unwrap();
        assert_eq!(shape_of(&valid.surface), Shape::Tube, "{format}");
        assert_eq!(valid.surface.vertex_count(), 20);
        // Five chords round a circle of 100 mm: 5 · 2 r sin 36° · 30 mm.
        let area = 5.0 * 2.0 * 100.0 / TAU * (TAU / 10.0).sin() * 30.0;
        assert!((valid.surface.total_area() - area).abs() < 0.1, "{format}");
    }
}

#[test]
fn damaged_files_are_refused_or_mended_and_never_a_fault() {
    let files = files();
    // xorshift64 (Marsaglia 2003): the same damage in every run.
    let mut state = 0x1234_5678_9abc_def1u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    let (mut refused, mut mended) = (0, 0);
    for _ in 0..4000 {
        let (format, whole) = &files[random(files.len())];
        let mut bytes = whole.clone();
        for _ in 0..=random(4) {
            let at = random(bytes.len());
            match random(5) {
                0 => bytes[at] = u8::try_from(random(256)).unwrap(),
                1 => drop(bytes.remove(at)),
                2 => bytes[at] ^= 1 << random(8),
                3 => bytes[at] = b"0123456789-. \n/"[random(15)],
                _ => bytes[at] = bytes[random(bytes.len())],
            }
        }
        let options =
            SurfaceOptions { keep_largest: random(2) == 0, close_holes: 500.0, ..OPTIONS };
        match read(&bytes, *format).map(|raw| validate(&raw, &options)) {
            Ok(Ok(_)) => mended += 1,
            Ok(Err(error)) => assert!(!error.is_fault(), "{error}"),
            Err(_) => refused += 1,
        }
    }
    assert!(refused > 1000 && mended > 100, "{refused} refused, {mended} mended");
}
