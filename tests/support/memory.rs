//! A disk in memory that knows what would survive a power cut: the content that was synced of files whose entries were
//! synced, up to the root, and nothing else.

use skilltree::run_folder::file_system::{FileSystem, Kind, Lock, TryLockError, Writing};
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::{self, Cursor, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard};

/// What an entry of a folder names. Folders are shared: a rename moves none of them.
#[derive(Debug, Clone)]
enum Node {
    File(Arc<Mutex<Content>>),
    Folder(Arc<Mutex<Folder>>),
}

#[derive(Debug, Default)]
struct Content {
    now: Vec<u8>,
    kept: Vec<u8>,
}

#[derive(Debug, Default)]
struct Folder {
    now: BTreeMap<OsString, Node>,
    kept: BTreeMap<OsString, Node>,
}

/// The disk. Paths start from its root, `/`.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    root: Arc<Mutex<Folder>>,
    locked: Arc<Mutex<Option<PathBuf>>>,
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

impl Memory {
    /// What the disk holds after a power cut.
    #[allow(dead_code, reason = "the fuzzer cuts no power")]
    pub(crate) fn after_a_power_cut(&self) -> Self {
        fn kept(folder: &Mutex<Folder>) -> Arc<Mutex<Folder>> {
            let entries = held(folder).kept.clone();
            let survivor = |node| match node {
                Node::Folder(folder) => Node::Folder(kept(&folder)),
                Node::File(file) => {
                    let bytes = held(&file).kept.clone();
                    Node::File(Arc::new(Mutex::new(Content { now: bytes.clone(), kept: bytes })))
                }
            };
            let entries: BTreeMap<_, _> = entries.into_iter().map(|(name, node)| (name, survivor(node))).collect();
            Arc::new(Mutex::new(Folder { now: entries.clone(), kept: entries }))
        }
        Self { root: kept(&self.root), ..Self::default() }
    }

    /// Another disk with the same files, all of them safe.
    pub(crate) fn of(files: &BTreeMap<PathBuf, Vec<u8>>) -> Self {
        let disk = Self::default();
        for (path, bytes) in files {
            disk.make_folder(path.parent().unwrap()).unwrap();
            let mut file = disk.create(path).unwrap();
            file.write_all(bytes).unwrap();
            file.sync().unwrap();
            path.ancestors().skip(1).for_each(|folder| disk.sync_folder(folder).unwrap());
        }
        disk
    }

    /// Every file by its path.
    pub(crate) fn files(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut found = BTreeMap::new();
        let mut open = vec![(PathBuf::from("/"), Arc::clone(&self.root))];
        while let Some((path, folder)) = open.pop() {
            for (name, node) in &held(&folder).now {
                match node {
                    Node::Folder(folder) => open.push((path.join(name), Arc::clone(folder))),
                    Node::File(file) => drop(found.insert(path.join(name), held(file).now.clone())),
                }
            }
        }
        found
    }

    fn folder(&self, path: &Path) -> io::Result<Arc<Mutex<Folder>>> {
        let mut at = Arc::clone(&self.root);
        for name in path.strip_prefix("/").map_err(|_| ErrorKind::InvalidInput)? {
            let next = held(&at).now.get(name).cloned();
            at = match next {
                Some(Node::Folder(folder)) => folder,
                Some(Node::File(_)) => return Err(ErrorKind::NotADirectory.into()),
                None => return Err(ErrorKind::NotFound.into()),
            };
        }
        Ok(at)
    }

    /// The folder that holds a path, and the path's last word.
    fn place(&self, path: &Path) -> io::Result<(Arc<Mutex<Folder>>, OsString)> {
        let name = path.file_name().ok_or(ErrorKind::InvalidInput)?.to_owned();
        Ok((self.folder(path.parent().ok_or(ErrorKind::InvalidInput)?)?, name))
    }

    fn node(&self, path: &Path) -> io::Result<Node> {
        if path == Path::new("/") {
            return Ok(Node::Folder(Arc::clone(&self.root)));
        }
        let (folder, name) = self.place(path)?;
        let node = held(&folder).now.get(&name).cloned();
        node.ok_or(ErrorKind::NotFound.into())
    }
}

struct Writer(Arc<Mutex<Content>>);

impl Write for Writer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        held(&self.0).now.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Writing for Writer {
    fn sync(&mut self) -> io::Result<()> {
        let mut content = held(&self.0);
        content.kept = content.now.clone();
        Ok(())
    }
}

/// Gives the lock back.
struct Holder(Arc<Mutex<Option<PathBuf>>>);

impl Drop for Holder {
    fn drop(&mut self) {
        *held(&self.0) = None;
    }
}

impl FileSystem for Memory {
    fn make_folder(&self, path: &Path) -> io::Result<()> {
        let mut at = Arc::clone(&self.root);
        for name in path.strip_prefix("/").map_err(|_| ErrorKind::InvalidInput)? {
            let new = || Node::Folder(Arc::default());
            let next = held(&at).now.entry(name.to_owned()).or_insert_with(new).clone();
            let Node::Folder(folder) = next else { return Err(ErrorKind::AlreadyExists.into()) };
            at = folder;
        }
        Ok(())
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn Writing>> {
        let (folder, name) = self.place(path)?;
        let mut folder = held(&folder);
        let node = folder.now.entry(name).or_insert_with(|| Node::File(Arc::default()));
        let Node::File(file) = node else { return Err(ErrorKind::IsADirectory.into()) };
        held(file).now.clear();
        Ok(Box::new(Writer(Arc::clone(file))))
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        match self.node(path)? {
            Node::File(file) => Ok(Box::new(Cursor::new(held(&file).now.clone()))),
            Node::Folder(_) => Err(ErrorKind::IsADirectory.into()),
        }
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        let (folder, name) = self.place(from)?;
        let (other, new) = self.place(to)?;
        assert!(Arc::ptr_eq(&folder, &other), "files are put in place within their folder");
        let mut folder = held(&folder);
        let node = folder.now.remove(&name).ok_or(ErrorKind::NotFound)?;
        folder.now.insert(new, node);
        Ok(())
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        let folder = self.folder(path)?;
        let mut folder = held(&folder);
        folder.kept = folder.now.clone();
        Ok(())
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        let (folder, name) = self.place(path)?;
        held(&folder).now.remove(&name).map(drop).ok_or(ErrorKind::NotFound.into())
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        if !held(&*self.folder(path)?).now.is_empty() {
            return Err(ErrorKind::DirectoryNotEmpty.into());
        }
        self.remove_file(path)
    }

    fn list(&self, path: &Path) -> io::Result<Vec<OsString>> {
        Ok(held(&*self.folder(path)?).now.keys().cloned().collect())
    }

    fn kind(&self, path: &Path) -> io::Result<Option<Kind>> {
        match self.node(path) {
            Ok(Node::Folder(_)) => Ok(Some(Kind::Folder)),
            Ok(Node::File(_)) => Ok(Some(Kind::File)),
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn lock(&self, path: &Path) -> Result<Lock, TryLockError> {
        self.place(path).and_then(|_| self.create(path)).map_err(TryLockError::Error)?;
        let mut locked = held(&self.locked);
        if locked.is_some() {
            return Err(TryLockError::WouldBlock);
        }
        *locked = Some(path.to_owned());
        Ok(Box::new(Holder(Arc::clone(&self.locked))))
    }
}
