#nullable enable
using System;
using UnityEngine;

namespace HaptoFlow.SampleScenes
{
    /// <summary>Builds the sample when it wakes: three plates, a pen under the mouse, a pen for each hand in a headset,
    /// the check itself, and a board with its instructions.</summary>
    internal sealed class DeviceCheckScene : BuiltScene
    {
        private static readonly Vector3 PlateMetres = new Vector3(0.18f, 0.02f, 0.24f);

        private static readonly (string Label, float X, Color Colour)[] Plates =
        {
            ("glass", -0.2f, new Color(0.55f, 0.75f, 0.85f)),
            ("wood", 0f, new Color(0.6f, 0.42f, 0.25f)),
            ("corduroy", 0.2f, new Color(0.4f, 0.3f, 0.45f)),
        };

        private ButtonPress yes = null!;
        private ButtonPress no = null!;
        private ButtonPress skip = null!;
        private TextMesh board = null!;

        public DeviceCheckRun Run { get; private set; } = null!;

        public string Words => board.text;

        public override void Sketch() => Array.ForEach(Plates, each => SceneSketch.DrawBox(
            PlaceOf(each.X), PlateMetres, each.Colour));

        private void Awake()
        {
            UseModelIfNoneIsSet();
            foreach ((string label, float x, Color colour) in Plates)
            {
                GameObject plate = SceneObjects.AddSolid(
                    label, PrimitiveType.Cube, PlaceOf(x), PlateMetres, colour);
                SceneObjects.AddSurface(plate, label).Grain = Vector3.right;
            }
            MousePen mouse = MousePen.Create(View!);
            XrRig rig = XrRig.Create(View);
            rig.MousePen = mouse;
            rig.AddPen(PenHand.Right);
            rig.AddPen(PenHand.Left);
            board = SceneObjects.AddText("", new Vector3(0f, 0.16f, 0.25f), View!.transform.rotation);
            yes = new ButtonPress("<Keyboard>/y",
                "<XRController>{RightHand}/primaryButton", "<XRController>{LeftHand}/primaryButton");
            no = new ButtonPress("<Keyboard>/n",
                "<XRController>{RightHand}/secondaryButton", "<XRController>{LeftHand}/secondaryButton");
            skip = new ButtonPress("<Keyboard>/s");
            Run = gameObject.AddComponent<DeviceCheckRun>();
        }

        private void Update()
        {
            bool? answer = ButtonPress.Answer(yes, no);
            if (answer != null)
            {
                Run.Answer(answer.Value);
            }
            if (skip.IsNew())
            {
                Run.Skip();
            }
            if (!ReferenceEquals(board.text, Run.Instruction))
            {
                board.text = Run.Instruction;
            }
        }

        private void OnDestroy()
        {
            yes.Dispose();
            no.Dispose();
            skip.Dispose();
        }

        private static Vector3 PlaceOf(float x) => new Vector3(x, -0.5f * PlateMetres.y, 0f);
    }
}
