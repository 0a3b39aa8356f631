#nullable enable
using System;
using System.Collections;
using HaptoFlow.Alignment;
using NUnit.Framework;
using UnityEngine;
using UnityEngine.TestTools;

namespace HaptoFlow.Tests
{
    /// <summary>A virtual board is aligned with a real desk by touching three of its points.</summary>
    public sealed class HapticAlignmentTests : SceneTest
    {
        private static readonly Vector3[] Corners =
        {
            new Vector3(-0.2f, 0f, -0.2f), new Vector3(0.2f, 0f, -0.2f), new Vector3(-0.2f, 0f, 0.1f),
        };

        private readonly Vector3 deskPosition = new Vector3(0.3f, 0.75f, -0.1f);
        private readonly Quaternion deskRotation = Quaternion.AngleAxis(25f, Vector3.up) *
            Quaternion.AngleAxis(3f, Vector3.right);

        private HapticSurface board = null!;
        private HapticStylus stylus = null!;
        private FixedForce force = null!;
        private HapticAlignment alignment = null!;
        private Vector3 hand;
        private string name = "";

        [SetUp]
        public void MakeADesk()
        {
            name = "test " + Guid.NewGuid();
            board = Board();
            hand = new Vector3(0f, 1.2f, 0f);
            stylus = StylusAlong(_ => hand);
            force = stylus.gameObject.AddComponent<FixedForce>();
            stylus.Force = force;
            alignment = board.gameObject.AddComponent<HapticAlignment>();
            alignment.Stylus = stylus;
            alignment.SaveName = name;
            alignment.SetMarks(Corners[0], Corners[1], Corners[2]);
        }

        [TearDown]
        public void LeaveNoFile() => new AlignmentFile(name).Save(null, board);

        [UnityTest]
        public IEnumerator ThreeRestsOfAPressingPenAlignTheBoardWithTheDesk()
        {
            yield return TakeAll();
            Assert.That(alignment.Message, Does.StartWith("Aligned; 0.0 mm"));
            AssertOnDesk(board.transform);
        }

        [UnityTest]
        public IEnumerator APenWithoutForceTakesPointsByCallingTakePoint()
        {
            yield return TakePoints(0, 1, 2);
            AssertOnDesk(board.transform);
            Assert.That(() => alignment.TakePoint(), Throws.TypeOf<InvalidOperationException>());
        }

        [UnityTest]
        public IEnumerator AScaledBoardBelowAMovedParentIsAlignedToo()
        {
            GameObject parent = Make("rig");
            parent.transform.SetPositionAndRotation(
                new Vector3(3f, 1f, 2f), Quaternion.AngleAxis(70f, Vector3.up));
            board.transform.SetParent(parent.transform, false);
            board.transform.localScale = new Vector3(2f, 1f, 0.5f);
            alignment.SetMarks(
                new Vector3(-0.1f, 0f, -0.4f), new Vector3(0.1f, 0f, -0.4f), new Vector3(-0.1f, 0f, 0.2f));
            yield return TakeAll();
            AssertOnDesk(board.transform);
        }

        [UnityTest]
        public IEnumerator TheJumpOfAnAlignmentDoesNotCountAsSpeed()
        {
            FinishLoading();
            Output(out _);
            stylus.TouchBy = TouchDecision.MeasuredForce;
            // The board is only slightly misplaced: the pen touches it before, while and after it moves.
            board.transform.SetPositionAndRotation(deskPosition + new Vector3(0.008f, 0.006f, 0f), deskRotation);
            yield return null;
            alignment.Begin();
            float fastest = 0f;
            // The board moves while the pen rests on the third mark; lowering the pen is a real motion of the hand.
            void Watch(HapticStylus _, in HapticContact contact) => fastest = alignment.IsTaking
                ? 0f
                : Mathf.Max(fastest, contact.TangentialVelocity.magnitude);
            stylus.TouchBegan += Watch;
            stylus.TouchMoved += Watch;
            yield return RestOnAll();
            force.ForceNewtons = 1f;
            yield return Frames(20);
            Assert.That(stylus.IsTouching, Is.True);
            Assert.That(fastest, Is.LessThan(0.01f));
        }

        [UnityTest]
        public IEnumerator UndoRemovesAPointAndLaterTheWholeAlignment()
        {
            Vector3 before = board.transform.position;
            yield return null;
            alignment.Begin();
            yield return Rest(0);
            yield return Rest(2);
            Assert.That(alignment.PointsTaken, Is.EqualTo(2));
            alignment.Undo();
            Assert.That(alignment.PointsTaken, Is.EqualTo(1));
            yield return Rest(1);
            yield return Rest(2);
            AssertOnDesk(board.transform);
            alignment.Undo();
            Assert.That(Vector3.Distance(board.transform.position, before), Is.LessThan(1e-6f));
            alignment.Undo();
            Assert.That(Vector3.Distance(board.transform.position, before), Is.LessThan(1e-6f));
        }

        [UnityTest]
        public IEnumerator ATouchedTriangleThatDiffersIsRefusedWithAReason()
        {
            Vector3 before = board.transform.position;
            yield return TakePoints(1, 0, 2);
            Assert.That(alignment.Message, Does.StartWith("Not aligned: ").And.Contain("order of their numbers"));
            Assert.That(alignment.IsTaking, Is.True, "it starts again from the first");
            Assert.That(alignment.PointsTaken, Is.Zero);
            Assert.That(Vector3.Distance(board.transform.position, before), Is.Zero);
        }

        [UnityTest]
        public IEnumerator TheNextSessionRestoresTheAlignment()
        {
            yield return TakeAll();
            HapticSurface next = Board();
            var restored = next.gameObject.AddComponent<HapticAlignment>();
            restored.SaveName = name;
            yield return null;
            AssertOnDesk(next.transform);
            Assert.That(restored.IsAligned, Is.True);
            restored.Undo();
            Assert.That(next.transform.position.magnitude, Is.LessThan(1e-6f));
            Assert.That(restored.IsAligned, Is.False);
            HapticSurface third = Board();
            third.gameObject.AddComponent<HapticAlignment>().SaveName = name;
            yield return null;
            Assert.That(third.transform.position.magnitude, Is.LessThan(1e-6f), "an undone alignment is not saved");
        }

        [UnityTest]
        public IEnumerator AMissingStylusIsReportedAndMarksWithoutAPoseAreRefused()
        {
            alignment.Stylus = null;
            yield return null;
            alignment.Begin();
            Assert.That(alignment.Message, Does.Contain("no stylus"));
            Assert.That(() => alignment.TakePoint(), Throws.TypeOf<InvalidOperationException>());
            Assert.That(() => alignment.SetMarks(Corners[0], Corners[1], 0.5f * (Corners[0] + Corners[1])),
                Throws.TypeOf<ArgumentException>().With.Message.Contains("almost on one line"));
            alignment.enabled = false;
            Assert.That(alignment.IsTaking, Is.False);
        }

        private IEnumerator TakePoints(params int[] corners)
        {
            stylus.Force = null;
            yield return null;
            alignment.Begin();
            foreach (int corner in corners)
            {
                hand = TipOn(corner);
                yield return null;
                alignment.TakePoint();
            }
        }

        private IEnumerator TakeAll()
        {
            yield return null;
            alignment.Begin();
            Assert.That(alignment.Message, Does.Contain("mark 1 of 3"));
            yield return RestOnAll();
        }

        private IEnumerator RestOnAll()
        {
            for (int corner = 0; corner < 3; ++corner)
            {
                yield return Rest(corner);
            }
            Assert.That(alignment.IsTaking, Is.False, alignment.Message);
        }

        /// <summary>Lowers the pen onto a corner of the real desk, presses for half a second, and lifts it.</summary>
        private IEnumerator Rest(int corner)
        {
            hand = TipOn(corner) + 0.05f * Vector3.up;
            force.ForceNewtons = 0f;
            yield return Frames(5);
            hand = TipOn(corner);
            force.ForceNewtons = 0.8f;
            yield return Frames(50);
            force.ForceNewtons = 0f;
            yield return Frames(2);
        }

        /// <summary>The tip's centre is one tip radius above the desk.</summary>
        private Vector3 TipOn(int corner) => deskPosition +
            deskRotation * (Corners[corner] + stylus.TipRadiusMetres * Vector3.up);

        private void AssertOnDesk(Transform moved)
        {
            Assert.That(Vector3.Distance(moved.position, deskPosition), Is.LessThan(1e-4f));
            foreach (Vector3 axis in new[] { Vector3.up, Vector3.right })
            {
                Assert.That(Vector3.Distance(moved.rotation * axis, deskRotation * axis), Is.LessThan(1e-3f));
            }
        }
    }
}
