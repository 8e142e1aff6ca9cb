//! Writes particles for ParaView: one `.vtu` file for each recorded step, and the `.pvd` file
//! that ties them to their times.

use crate::run::Frame;
use crate::run::table::{Table, shortest};
use crate::scene::fault::Fault;
use crate::scene::keys::AXES;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, IOBuffer, UnstructuredGridPiece,
    Version, VertexNumbers, Vtk,
};

/// Names frame `n`.
pub fn name(n: usize) -> String {
    format!("particles_{n:06}.vtu")
}

/// Writes all files of the series.
///
/// Errors: [`Fault::Write`]; [`Fault::NotFinite`].
pub fn files(frames: &[Frame]) -> Result<Vec<(String, Vec<u8>)>, Fault> {
    let mut files = Vec::new();
    for (n, frame) in frames.iter().enumerate() {
        files.push((name(n), vtu(&frame.particles)?));
    }
    if !frames.is_empty() {
        files.push(("particles.pvd".to_string(), pvd(frames)));
    }
    Ok(files)
}

/// Writes each particle as a vertex with its displacement, velocity, stress, density and
/// mass; missing axes are 0.
fn vtu(particles: &Table) -> Result<Vec<u8>, Fault> {
    particles.finite()?;
    let count = particles.rows().len();
    let vtk = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(UnstructuredGridPiece {
            points: together(particles, &vector("position")),
            cells: Cells {
                cell_verts: VertexNumbers::XML {
                    connectivity: (0..count as u64).collect(),
                    offsets: (1..=count as u64).collect(),
                },
                types: vec![CellType::Vertex; count],
            },
            data: Attributes { point: attributes(particles), cell: Vec::new() },
        }),
    };
    let mut bytes = Vec::new();
    vtk.write_xml(&mut bytes).map_err(|error| Fault::Write {
        path: "VTK".into(),
        source: std::io::Error::other(error.to_string()),
    })?;
    Ok(bytes)
}

/// Names the columns of a vector.
fn vector(name: &str) -> Vec<String> {
    AXES.iter().map(|axis| format!("{name}_{axis}")).collect()
}

/// Names the columns of the stress, of whose symmetric halves the table has the upper one.
fn tensor() -> Vec<String> {
    let pairs = (0..9).map(|n: usize| (n / 3, n % 3));
    pairs.map(|(i, j)| format!("stress_{}{}", AXES[i.min(j)], AXES[i.max(j)])).collect()
}

/// Lists what every particle carries.
fn attributes(particles: &Table) -> Vec<Attribute> {
    let scalar = |name: &str| {
        Attribute::scalars(name, 1).with_data(together(particles, &[name.to_string()]))
    };
    let vectors =
        |name: &str| Attribute::vectors(name).with_data(together(particles, &vector(name)));
    vec![
        vectors("displacement"),
        vectors("velocity"),
        Attribute::tensors("stress").with_data(together(particles, &tensor())),
        scalar("density"),
        scalar("mass"),
    ]
}

/// Puts the components of every particle together, one particle after the other.
fn together(particles: &Table, names: &[String]) -> IOBuffer {
    let count = particles.rows().len();
    let column = |name: &String| particles.column(name).unwrap_or_else(|| vec![0.0; count]);
    let columns: Vec<Vec<f64>> = names.iter().map(column).collect();
    let values = (0..count).flat_map(|p| columns.iter().map(move |column| column[p]));
    values.collect::<Vec<f64>>().into()
}

/// Writes the list of files with their times (s).
fn pvd(frames: &[Frame]) -> Vec<u8> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (n, frame) in frames.iter().enumerate() {
        let time = shortest(frame.time);
        text += &format!("<DataSet timestep=\"{time}\" file=\"{}\"/>\n", name(n));
    }
    text += "</Collection>\n</VTKFile>\n";
    text.into_bytes()
}
