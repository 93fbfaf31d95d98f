//! What earlier checks found, so that an unchanged asset isn't measured again.

use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};
use walkdir::WalkDir;

use super::report::Asset;
use load::files::write_whole;

/// The most files of a folder that are looked at for [`listing`]. A folder with more is never taken for unchanged.
const MOST_LISTED: usize = 10_000;

/// A folder with a file for each asset and configuration.
#[derive(Clone, Debug)]
pub struct Cache(PathBuf);

/// What an asset's result depends on besides the contents of files: its path, and everything of the configuration that holds
/// for it, as text.
pub type Inputs<'a> = (&'a Path, &'a str);

/// A file of the cache.
#[derive(Serialize, Deserialize)]
struct Record {
    /// Every file that was read, with the hash of its content.
    files: Vec<(PathBuf, String)>,
    /// The hash of the names in the asset's folder, if loading gave warnings: a file that is named and missing may be there now.
    listing: Option<String>,
    asset: Asset,
}

impl Cache {
    pub fn new(folder: &Path) -> Self {
        Self(folder.to_owned())
    }

    /// What was found about an asset, if neither its inputs nor any file that was read for it has changed. A record that can't be
    /// read counts as none.
    pub fn get(&self, inputs: Inputs) -> Option<Asset> {
        let record: Record = serde_json::from_slice(&std::fs::read(self.place(inputs)).ok()?).ok()?;
        let is_same = |(path, hash): &(PathBuf, String)| hash_of_file(path).is_ok_and(|own| own == *hash);
        let is_same_folder = record.listing.is_none() || record.listing == listing(inputs.0);
        let is_unchanged = is_same_folder && record.files.iter().all(is_same);
        is_unchanged.then_some(Asset { unchanged: true, ..record.asset })
    }

    /// Keeps what was found about an asset. `files` are those that were read for it, from `start` on. What couldn't be checked isn't
    /// kept, since the reason may lie elsewhere; neither is what was written meanwhile, since it may not be what was measured.
    pub fn put(&self, inputs: Inputs, files: &[PathBuf], start: SystemTime, asset: &Asset) -> io::Result<()> {
        let modified = |path: &PathBuf| std::fs::metadata(path).and_then(|about| about.modified());
        let is_newer = |path| modified(path).is_ok_and(|time| time >= start);
        if asset.error.is_some() || files.iter().any(is_newer) {
            return Ok(());
        }
        let hashed = |path: &PathBuf| Ok((path.clone(), hash_of_file(path)?));
        let files = files.iter().map(hashed).collect::<io::Result<_>>()?;
        let listing = if asset.warnings.is_empty() { None } else { Some(listing(inputs.0).unwrap_or_default()) };
        let record = Record { files, listing, asset: asset.clone() };
        write_whole(&self.place(inputs), &serde_json::to_vec(&record)?)
    }

    fn place(&self, (path, configuration): Inputs) -> PathBuf {
        let mut hasher = blake3::Hasher::new();
        for part in
            [env!("CARGO_PKG_VERSION").as_bytes(), path.as_os_str().as_encoded_bytes(), configuration.as_bytes()]
        {
            // With its length, so that no two lists of parts are the same bytes.
            hasher.update(&(part.len() as u64).to_le_bytes()).update(part);
        }
        self.0.join(format!("{}.json", hasher.finalize().to_hex()))
    }
}

fn hash_of_file(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(std::fs::File::open(path)?)?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// The hash of all names in an asset's folder and below it, where the files that it names lie; none if they are too many, or a
/// folder can't be read.
fn listing(asset: &Path) -> Option<String> {
    let folder = asset.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = WalkDir::new(folder).min_depth(1).into_iter().take(MOST_LISTED + 1);
    let mut names = entries.map(|entry| Some(entry.ok()?.into_path())).collect::<Option<Vec<_>>>()?;
    if names.len() > MOST_LISTED {
        return None;
    }
    names.sort();
    let mut hasher = blake3::Hasher::new();
    for name in names {
        hasher.update(name.as_os_str().as_encoded_bytes()).update(b"\0");
    }
    Some(hasher.finalize().to_hex().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_asset_is_unchanged_until_a_file_or_its_inputs_change() {
        let folder = tempfile::tempdir().expect("a folder");
        let (asset, image) = (folder.path().join("a.gltf"), folder.path().join("a.png"));
        let write = |path: &Path, text: &str| std::fs::write(path, text).expect("a writable folder");
        write(&asset, "mesh");
        write(&image, "image");
        let cache = Cache::new(&folder.path().join("."));
        let inputs = (&*asset, "lod=error");
        let found = Asset { path: "a.gltf".into(), ..Asset::default() };
        let files = [asset.clone(), image.clone()];
        assert_eq!(cache.get(inputs), None);
        cache.put(inputs, &files, SystemTime::UNIX_EPOCH, &found).expect("nothing is written");
        assert_eq!(cache.get(inputs), None, "the files were written after the start");
        let put = || cache.put(inputs, &files, SystemTime::now(), &found).expect("a writable folder");
        put();
        assert_eq!(cache.get(inputs), Some(Asset { unchanged: true, ..found.clone() }));
        assert_eq!(cache.get((&asset, "lod=paper")), None);
        write(&image, "other");
        assert_eq!(cache.get(inputs), None);
        put();
        assert!(cache.get(inputs).is_some());
        std::fs::remove_file(&image).expect("a file");
        assert_eq!(cache.get(inputs), None);
        std::fs::write(cache.place(inputs), "{").expect("a writable folder");
        assert_eq!(cache.get(inputs), None, "a damaged record counts as none");
    }

    #[test]
    fn an_asset_with_warnings_is_checked_again_when_a_file_appears() {
        let [folder, kept] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        let asset = folder.path().join("a.gltf");
        std::fs::write(&asset, "mesh").expect("a writable folder");
        let cache = Cache::new(kept.path());
        let inputs = (&*asset, "");
        let found = Asset { warnings: vec!["a.png is missing".into()], ..Asset::default() };
        cache.put(inputs, std::slice::from_ref(&asset), SystemTime::now(), &found).expect("a writable folder");
        assert!(cache.get(inputs).is_some());
        std::fs::write(folder.path().join("a.png"), "image").expect("a writable folder");
        assert_eq!(cache.get(inputs), None);
        let broken = Asset { error: Some("no mesh".into()), ..Asset::default() };
        let other = (&*asset, "other");
        cache.put(other, &[], SystemTime::now(), &broken).expect("nothing is written");
        assert_eq!(cache.get(other), None);
    }
}
