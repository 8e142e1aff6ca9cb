//! Particles for ParaView: one `.vtu` file for each recorded step, and the
//! `.pvd` file that ties them to their times.

use crate::run::Frame;
use crate::run::table::{Table, shortest};
use crate::scene::fault::Fault;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataSet, IOBuffer, UnstructuredGridPiece,
    Version, VertexNumbers, Vtk,
};

/// The name of frame `n`.
pub fn name(n: usize) -> String {
    format!("particles_{n:06}.vtu")
}

/// True for the name of a frame, of any run.
pub fn is_frame(name: &str) -> bool {
    let number = name.strip_prefix("particles_").and_then(|rest| rest.strip_suffix(".vtu"));
    number.is_some_and(|n| !n.is_empty() && n.chars().all(|c| c.is_ascii_digit()))
}

/// All files of the series.
///
/// Errors: [`Fault::Write`].
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

/// Each particle is a vertex with its displacement, velocity, stress, density
/// and mass; missing axes are 0.
fn vtu(particles: &Table) -> Result<Vec<u8>, Fault> {
    let count = particles.rows().len();
    let column = |name: String| particles.column(&name).unwrap_or_else(|| vec![0.0; count]);
    // The components p = 0, 1, … of every particle, one particle after the other.
    let together = |names: Vec<String>| -> IOBuffer {
        let columns: Vec<Vec<f64>> = names.into_iter().map(column).collect();
        let values = (0..count).flat_map(|p| columns.iter().map(move |column| column[p]));
        values.collect::<Vec<f64>>().into()
    };
    let axes = ["x", "y", "z"];
    let vector = |name: &str| together(axes.iter().map(|axis| format!("{name}_{axis}")).collect());
    // Only the upper half of the symmetric stress is in the table.
    let tensor = (0..9).map(|n: usize| (n / 3, n % 3)).map(|(i, j)| {
        let (i, j) = (i.min(j), i.max(j));
        format!("stress_{}{}", axes[i], axes[j])
    });
    let scalar =
        |name: &str| Attribute::scalars(name, 1).with_data(together(vec![name.to_string()]));
    let vtk = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        file_path: None,
        data: DataSet::inline(UnstructuredGridPiece {
            points: vector("position"),
            cells: Cells {
                cell_verts: VertexNumbers::XML {
                    connectivity: (0..count as u64).collect(),
                    offsets: (1..=count as u64).collect(),
                },
                types: vec![CellType::Vertex; count],
            },
            data: Attributes {
                point: vec![
                    Attribute::vectors("displacement").with_data(vector("displacement")),
                    Attribute::vectors("velocity").with_data(vector("velocity")),
                    Attribute::tensors("stress").with_data(together(tensor.collect())),
                    scalar("density"),
                    scalar("mass"),
                ],
                cell: Vec::new(),
            },
        }),
    };
    let mut bytes = Vec::new();
    vtk.write_xml(&mut bytes).map_err(|error| Fault::Write {
        path: "VTK".into(),
        source: std::io::Error::other(error.to_string()),
    })?;
    Ok(bytes)
}

/// The list of files with their times (s).
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
