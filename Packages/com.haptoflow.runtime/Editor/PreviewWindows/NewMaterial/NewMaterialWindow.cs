#nullable enable
using System.IO;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Window > HaptoFlow > New Material from Recording: learns a material from a recording of ten seconds,
    /// compares both, and saves the material as an asset. Learning and rendering run in the background.</summary>
    internal sealed class NewMaterialWindow : EditorWindow
    {
        private const float Width = 1200f;
        private const float Height = 760f;

        // A smaller window scrolls.
        private const float MinimumWidth = 480f;
        private const float MinimumHeight = 320f;

        private static readonly string[] FileFilters = { "Recordings", "csv,wav" };

        [SerializeField]
        private NewMaterialState? state;

        private EditorPicture? picture;
        private NewMaterialControls? controls;
        private NewMaterialPlayer? player;
        private PreviewView? view;
        private Vector2 scroll;

        /// <summary>For scripts and tests that control the window.</summary>
        internal NewMaterialState State => state!;

        /// <summary>Null while the window is closed.</summary>
        internal NewMaterialSession? Session { get; private set; }

        /// <summary>Null while the window is closed.</summary>
        internal NewMaterialPlayer? Player => player;

        [MenuItem("Window/HaptoFlow/New Material from Recording", false, 2101)]
        internal static void Open()
        {
            bool isNew = !HasOpenInstances<NewMaterialWindow>();
            var window = GetWindow<NewMaterialWindow>();
            if (isNew)
            {
                Rect place = window.position;
                window.position = new Rect(place.x, place.y, Width, Height);
            }
        }

        private void OnEnable()
        {
            titleContent = new GUIContent("New Material");
            minSize = new Vector2(MinimumWidth, MinimumHeight);
            if (state == null)
            {
                state = CreateInstance<NewMaterialState>();
                state.hideFlags = HideFlags.HideAndDontSave;
            }
            Session = new NewMaterialSession(state);
            picture = new EditorPicture(DrawCharts);
            player = new NewMaterialPlayer(state, Session);
            controls = new NewMaterialControls(state);
            // A modal dialog within OnGUI would disturb the layout, so that it opens after the event.
            controls.ChoosePressed += () => EditorApplication.delayCall += Choose;
            controls.LearnPressed += Learn;
            controls.SavePressed += () => EditorApplication.delayCall += Save;
            controls.ExportPressed += () => EditorApplication.delayCall += Export;
            Undo.undoRedoPerformed += OnUndo;
            EditorApplication.update += Step;
            AssemblyReloadEvents.beforeAssemblyReload += Release;
        }

        private void OnDisable()
        {
            Undo.undoRedoPerformed -= OnUndo;
            EditorApplication.update -= Step;
            AssemblyReloadEvents.beforeAssemblyReload -= Release;
            Release();
        }

        private void OnDestroy()
        {
            if (state != null)
            {
                DestroyImmediate(state);
            }
        }

        private void OnGUI()
        {
            if (Session == null)
            {
                return;
            }
            view = PreviewView.Of(position, PreviewRoom.WithoutStroke, view);
            PreviewLayout layout = view.Layout;
            var all = new Rect(0f, 0f, (float)layout.Width, (float)layout.Height);
            var window = new Rect(0f, 0f, position.width, position.height);
            using var scrolled = new GUI.ScrollViewScope(window, scroll, all);
            scroll = scrolled.scrollPosition;
            using (new GUILayout.AreaScope(layout.Controls.ToRect()))
            {
                controls!.Draw(Session, player!, ModelInUse());
            }
            if (Session.Shown is { } shown)
            {
                picture!.OnGUI(shown, view);
                if (player!.PlayedSeconds is { } seconds)
                {
                    Playhead.DrawLines(layout.Charts, shown.Sounds, seconds, view.Palette);
                }
            }
        }

        /// <summary>Called at each editor update: submits changes, takes results, and continues playback.</summary>
        internal void Step()
        {
            if (Session == null)
            {
                return;
            }
            bool isOther = Session.Poll();
            Session.Refresh(ModelInUse());
            if (player!.Step() || isOther)
            {
                Repaint();
            }
        }

        /// <summary>Blocks until nothing runs any more.</summary>
        internal void Finish()
        {
            Session!.Finish(() => Session.Refresh(ModelInUse()));
            player!.Step();
            Repaint();
        }

        /// <summary>Chooses a recording's file. Can be undone.</summary>
        internal void Take(string path) => State.Change("Recording", changed =>
        {
            changed.Path = path;
            changed.Name = "";
            changed.Licence = "";
            changed.SpeedMps = 0f;
            changed.ForceNewtons = 0f;
            changed.FullScaleMps2 = 0f;
        });

        internal void Learn()
        {
            HapticModelAsset? model = ModelInUse();
            if (model != null)
            {
                Session?.Learn(model);
            }
        }

        private void Choose()
        {
            string folder = State.Path.Length > 0 ? Path.GetDirectoryName(State.Path) ?? "" : "";
            string path = EditorUtility.OpenFilePanelWithFilters("Choose Recording", folder, FileFilters);
            if (path.Length > 0)
            {
                Take(path);
            }
        }

        private void Save()
        {
            if (Session == null || State.Material.Length == 0)
            {
                return;
            }
            HapticMaterial? saved = MaterialAssets.SaveAs(State.Material, NearestLabel());
            if (saved != null)
            {
                Selection.activeObject = saved;
                ShowNotification(new GUIContent("Saved " + saved.name));
            }
        }

        private void Export()
        {
            if (Session == null || State.Material.Length == 0)
            {
                return;
            }
            string name = MaterialFile.Read(State.Material).Name;
            string path = EditorUtility.SaveFilePanel("Export Material File", "", name, "haptomaterial");
            if (path.Length > 0)
            {
                ShowNotification(new GUIContent(MaterialAssets.Export(path, State.Material) ?? "Exported"));
            }
        }

        /// <summary>The label to use where the learnt material is not available.</summary>
        private string NearestLabel()
        {
            const string unknown = "wood";
            return MaterialSummary.NearestLabel(ModelInUse(), MaterialFile.Read(State.Material)) ?? unknown;
        }

        private HapticModelAsset? ModelInUse() => State.Model != null ? State.Model : LabelCatalog.ModelInUse();

        private void OnUndo()
        {
            State.MarkChanged();
            Repaint();
        }

        private void DrawCharts(ICanvas canvas)
        {
            ComparisonResult shown = Session!.Shown!;
            shown.Panel.Draw(canvas, view!.Palette, view.Layout.Charts, shown.Active);
        }

        /// <summary>Frees everything that would outlive a domain reload.</summary>
        private void Release()
        {
            player?.Stop();
            Session?.Dispose();
            Session = null;
            picture?.Release();
        }
    }
}
